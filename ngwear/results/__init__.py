"""What a run leaves: records, files, what is read off them, and their extrapolation to zero element edge."""
