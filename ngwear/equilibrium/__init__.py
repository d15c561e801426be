"""The terms summed into one problem, solved by one Newton under one step control."""
