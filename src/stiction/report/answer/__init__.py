"""Answer about a device in words, tables and pictures, all made from one dataset of stage answer."""
