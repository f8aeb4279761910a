"""Tables and figures of studies of the contact."""
