"""Files: tables, plain data, HDF5, and result folders whose files are replaced as a whole."""
