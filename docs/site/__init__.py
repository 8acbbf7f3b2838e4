"""What makes the documentation site: pages from data, Sphinx's settings, the check of its links."""
