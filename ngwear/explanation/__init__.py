"""What a scene simulates, what it leaves out, and whether that matters."""
