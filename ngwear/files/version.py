"""The version of ngwear, which is also written into its files."""

VERSION = "0.2.0"
