"""Error of the model of the contact: its table, its column in other tables, its sentences."""
