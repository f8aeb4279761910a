"""Tables, figures and pages of devices."""
