"""The version of this program: what its files say that they were written by."""

VERSION = "0.2.0"
