"""Outlines of named splines, their recession, and the meshes made from them."""
