"""Tables and figures of the sensitivity and of the appendices."""
