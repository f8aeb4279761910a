"""Force curves from datasets: the way back from the files of stage contact."""

from stiction.contact.forcelaw import humid_curves
from stiction.contact.meniscus import laplace_pressure, meniscus_height


def force_curves(contact, humidity, temperature):
    """Distance (n_d,) [m] and ``curve(k)``, the force of sample k (n_d,) [Pa]; see `stiction.contact.forcelaw`.

    Parameters
    ----------
    contact : Dataset
        Stage contact.
    humidity, temperature : float
        Relative humidity [-] and absolute temperature of the water [K].
    """
    film = float(meniscus_height(humidity, temperature)), -float(laplace_pressure(humidity, temperature))
    starts = float(contact.distance[0]), float(contact.height[0])
    return humid_curves(contact.solid_pressure.values, contact.bearing_area.values, starts, float(contact.step), film)
