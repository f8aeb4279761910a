"""Settings of all tests."""

from hypothesis import settings

# Machines are shared: the time of one example says nothing. The same examples every time.
settings.register_profile("steady", deadline=None, derandomize=True)
settings.load_profile("steady")
