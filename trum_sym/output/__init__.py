"""How results leave: files written whole or not at all, JSON, tables, progress."""
