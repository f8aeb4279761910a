"""Tables and figures of surfaces (Secs. II and IV-A)."""
