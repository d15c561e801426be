"""From the tables of a scene file to what they describe."""
