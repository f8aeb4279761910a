"""The command for an estimate, which needs few imports."""
