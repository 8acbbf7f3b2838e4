"""Accuracy studies: runnable commands that take longer than a test; tests run samples of them."""
