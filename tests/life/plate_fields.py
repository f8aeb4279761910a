"""Field of a plate of finite thickness over a plane by boundary elements: a second route to its fringes."""

import numpy as np


def _panels(width, thickness, gap, number):
    """Centres and half lengths of panels on the four sides, finer towards corners, and whether they are upright."""
    graded = (1 - np.cos(np.pi * np.arange(number + 1) / number)) / 2
    middle, half = (graded[1:] + graded[:-1]) / 2, np.diff(graded) / 2
    level, upright = np.full(number, gap), np.full(number, width / 2)
    sides = [
        ((middle - 0.5) * width, level, half * width, False),
        ((middle - 0.5) * width, level + thickness, half * width, False),
        (upright, gap + middle * thickness, half * thickness, True),
        (-upright, gap + middle * thickness, half * thickness, True),
    ]
    return [np.concatenate([np.broadcast_to(side[k], number) for side in sides]) for k in range(4)]


def _potential(along, across, half):
    """∫ ln r over a panel of a half length at distances along and across it from its centre."""

    def upto(end):
        square = end**2 + across**2
        return end * (np.log(np.maximum(square, 1e-300)) / 2 - 1) + across * np.arctan2(end, across)

    return upto(along + half) - upto(along - half)


def capacity(width, thickness, gap, number=60):
    """Capacity per length of a plate over an earthed plane, over ε0 [-]."""
    x, y, half, upright = _panels(width, thickness, gap, number)
    matrix = 0.0
    for sign, below in ((-1, y), (1, -y)):
        dx, dy = x[:, None] - x, y[:, None] - below
        along, across = np.where(upright, dy, dx), np.where(upright, dx, dy)
        matrix = matrix + sign * _potential(along, np.abs(across), half) / (2 * np.pi)
    return float(2 * half @ np.linalg.solve(matrix, np.ones(len(x))))


def width_of_force(width, thickness, gap):
    """Width of plates without fringes that attract each other as much [m]: -g² dC/dg."""
    step = 1e-3 * gap
    ahead, behind = (capacity(width, thickness, gap + sign * step) for sign in (1, -1))
    return gap**2 * (behind - ahead) / (2 * step)


def area_of_force(sides, gap, number):
    """Area of plates without fringes that attract each other as a thin rectangle attracts a plane [m²]: -g² dC/dg."""
    step = 1e-3 * gap
    ahead, behind = (_capacity_of_rectangle(sides, gap + sign * step, number) for sign in (1, -1))
    return gap**2 * (behind - ahead) / (2 * step)


def _capacity_of_rectangle(sides, gap, number):
    """Capacity of a thin rectangle over an earthed plane, over ε0 [m], by equal panels."""
    size = np.array(sides) / number
    x, y = (k.ravel() for k in np.meshgrid(*(np.arange(number) * one for one in size)))
    dx, dy = x[:, None] - x, y[:, None] - y
    near, mirrored = (_of_rectangle(dx, dy, distance, *size / 2) for distance in (0.0, 2 * gap))
    return float(4 * np.pi * size.prod() * np.linalg.solve(near - mirrored, np.ones(len(x))).sum())


def _of_rectangle(x, y, z, half_x, half_y):
    """∫∫ 1/r over a rectangle of two half lengths, at distances from its centre."""
    total = 0.0
    for i in (1, -1):
        for j in (1, -1):
            a, b = x + i * half_x, y + j * half_y
            r = np.sqrt(a**2 + b**2 + z**2)
            total = total + i * j * (a * np.log(b + r) + b * np.log(a + r) - z * np.arctan2(a * b, z * r))
    return total
