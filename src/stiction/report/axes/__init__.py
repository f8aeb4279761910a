"""Tables, figures and sentences on a device along an axis: the roughness of a surface, or the variable of a process."""
