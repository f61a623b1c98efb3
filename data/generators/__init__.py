"""Generators of the demo meshes and scenes; run through data/generate.py."""
