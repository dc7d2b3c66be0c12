"""The program, its modules, and the extension module."""
