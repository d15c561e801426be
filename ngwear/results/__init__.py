"""Results of a run: records, files, quantities of interest, and Richardson extrapolation."""
