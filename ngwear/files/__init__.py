"""What is read from and written to disk, whatever it holds: tables, and folders whose files are replaced as a whole."""
