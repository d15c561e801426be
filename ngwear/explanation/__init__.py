"""Which effects a scene simulates and neglects, and whether a neglected effect matters."""
