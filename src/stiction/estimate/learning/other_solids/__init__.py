"""Other solids than polysilicon: how their attraction changes what is learnt, and contacts on which it is tested."""
