"""Walks through scenes, drawn with reused pixels and fully traced, and how far the two are apart."""
