"""Tables and figures of released beams (Secs. IV and V)."""
