"""Tables, figures and checks of the results, compared with the published values (Secs. IV and V, App. A–C)."""
