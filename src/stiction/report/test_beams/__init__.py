"""Table and figure of test beams."""
