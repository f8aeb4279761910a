"""Beams under loads by cubic finite elements in SI units and load control: a second route to the folds."""

from dataclasses import dataclass

import numpy as np
from scipy.integrate import solve_ivp
from scipy.linalg import eigh

#: Points and weights of the integral of a load over an element.
POINTS, WEIGHTS = ((1 + np.polynomial.legendre.leggauss(4)[0]) / 2, np.polynomial.legendre.leggauss(4)[1] / 2)


@dataclass(frozen=True)
class Elements:
    """A cantilever or bridge of equal Hermite elements."""

    beam: object  #: `stiction.beam.cantilever.Beam`, of which all fields count
    clamps: int
    rigid: bool = False  #: whether a bridge stretches
    number: int = 32

    @property
    def size(self):
        """Length of an element [m]."""
        return self.beam.length / self.number

    @property
    def free(self):
        """Unknowns [u, u'] of all nodes that no clamp holds."""
        return np.arange(2, 2 * self.number + 2 - 2 * (self.clamps - 1))

    def assembled(self, element):
        """Matrix of the beam from that of an element."""
        whole = np.zeros((2 * self.number + 2,) * 2)
        for i in range(0, 2 * self.number, 2):
            whole[i : i + 4, i : i + 4] += element
        return whole

    def stiffness(self):
        """Bending, and ∫ u'² dx as a quadratic form."""
        s = self.size
        d = np.diag([1, s, 1, s])
        bending = np.array([[12, 6, -12, 6], [6, 4, -6, 2], [-12, -6, 12, -6], [6, 2, -6, 4]])
        slopes = np.array([[36, 3, -36, 3], [3, 4, -3, -1], [-36, -3, 36, -3], [3, -1, -3, 4]])
        bending = self.beam.bending_stiffness / s**3 * (d @ bending @ d)
        return self.assembled(bending), self.assembled(d @ slopes @ d / (30 * s))

    def forces(self, u, load):
        """Forces (n,) and their tangent (n, n) from the load per length and its derivative at the deflections."""
        s, x = self.size, POINTS
        shape = np.array([1 - 3 * x**2 + 2 * x**3, s * x * (1 - x) ** 2, 3 * x**2 - 2 * x**3, s * x**2 * (x - 1)])
        force, tangent = np.zeros(len(u)), np.zeros((len(u),) * 2)
        at = 2 * np.arange(self.number)[:, None] + np.arange(4)
        per_length, change = load(u[at] @ shape)
        np.add.at(force, at, s * (WEIGHTS * per_length) @ shape.T)
        np.add.at(
            tangent, (at[:, :, None], at[:, None]), s * np.einsum("ip,ep,jp->eij", shape, WEIGHTS * change, shape)
        )
        return force, tangent

    def balance(self, forces, start, within=1.0):
        """Deflection in balance with forces near a start, or ``None`` where Newton's method finds none within gaps."""
        bending, slopes = self.stiffness()
        stretching = self.beam.young_modulus * self.beam.width * self.beam.thickness / (2 * self.beam.length)
        u, free, node = start.copy(), self.free, slice(0, None, 2)
        for _ in range(60):
            along = slopes @ u
            pull = self.beam.tension + self.rigid * stretching * (u @ along)
            force, tangent = forces(u)
            residual = bending @ u + pull * along - force
            matrix = bending + pull * slopes + self.rigid * 2 * stretching * np.outer(along, along) - tangent
            step = np.zeros_like(u)
            step[free] = np.linalg.solve(matrix[np.ix_(free, free)], residual[free])
            u = u - step
            if not np.all(np.abs(u[node]) < within * self.beam.gap):
                return None
            if np.abs(step[node]).max() < 1e-10 * self.beam.gap:
                return u
        return None

    def stands(self, forces, steps=30):
        """Whether the beam stands under forces ``(share, u) -> forces, tangent`` that grow from nothing to share 1."""
        u = np.zeros(2 * self.number + 2)
        for share in 1 - np.linspace(1, 0, steps + 1)[1:] ** 2:
            u = self.balance(lambda v, share=share: forces(share, v), u)
            if u is None:
                return False
        return True

    def stands_at(self, voltage):
        """Whether it is not pulled in at a voltage [V]."""
        gap, force = self.beam.gap, 8.8541878128e-12 * voltage**2 * self.beam.width / 2

        def load(share, u):
            return share * force / (gap - u) ** 2, share * 2 * force / (gap - u) ** 3

        return self.stands(lambda share, u: self.forces(u, lambda v: load(share, v)))

    def stands_wet(self, tension, angle=0.0, pinned=None):
        """Whether it does not collapse while each cross-section has liquid of its own, of a tension γ [N/m] and angle.

        At both edges and at the free end it leaves the beam at any ``pinned`` angle (m,) that lets it stay there.
        """
        gap, width = self.beam.gap, self.beam.width
        angles = np.linspace(angle, np.pi, 401) if pinned is None else pinned
        end = np.zeros(2 * self.number + 2)
        end[-2] = tension * width * np.sin(angles).max() * (self.clamps == 1)

        def load(share, u):
            pulls = width / (gap - u)[..., None] * (np.cos(angle) + np.cos(angles)) + 2 * np.sin(angles)
            worst = angles[np.argmax(pulls, axis=-1)]
            change = width / (gap - u) ** 2 * (np.cos(angle) + np.cos(worst))
            return share * tension * pulls.max(axis=-1), share * tension * change

        def forces(share, u):
            along, tangent = self.forces(u, lambda v: load(share, v))
            return along + share * end, tangent

        return self.stands(forces)

    def stands_with_drop(self, adhesion, first):
        """As `stands_wet` with a connected liquid from node ``first`` to the end, or to the same node on the right."""
        gap, node, last = self.beam.gap, 2 * first, self.number - (self.clamps - 1) * first
        uniform, s = np.zeros(2 * self.number + 2), self.size
        for i in range(2 * first, 2 * last, 2):
            uniform[i : i + 4] += 2 * adhesion * self.beam.width * np.array([s / 2, s**2 / 12, s / 2, -(s**2) / 12])

        def forces(share, u):
            at_edge = np.eye(len(u))[node]
            tangent = np.outer(uniform, at_edge) / (gap - u[node]) ** 2
            return share * uniform / (gap - u[node]), share * tangent

        return self.stands(forces)

    def stands_drying(self, adhesion):
        """Whether it stands with a drop that begins at any node."""
        nodes = range(1, self.number if self.clamps == 1 else self.number // 2)
        return all(self.stands_with_drop(adhesion, first) for first in nodes)

    def sags_to(self, weight):
        """Deflection of the end or middle under a weight per length [N/m], in gaps."""
        forces = self.forces(np.zeros(2 * self.number + 2), lambda u: (weight + 0 * u, 0 * u))
        u = np.zeros(2 * self.number + 2)
        for share in np.linspace(0, 1, 11)[1:]:
            u = self.balance(lambda _, share=share: (share * forces[0], 0 * forces[1]), u, within=np.inf)
        return u[-2 if self.clamps == 1 else self.number] / self.beam.gap

    def modes(self, number):
        """Squared frequencies of the lowest modes, their shapes, and the mass of a length of one."""
        s, x = self.size, POINTS
        shape = np.array([1 - 3 * x**2 + 2 * x**3, s * x * (1 - x) ** 2, 3 * x**2 - 2 * x**3, s * x**2 * (x - 1)])
        mass = self.assembled(s * (WEIGHTS * shape) @ shape.T)
        bending, slopes = self.stiffness()
        free, shapes = np.ix_(self.free, self.free), np.zeros((len(mass), number))
        squares, kept = eigh((bending + self.beam.tension * slopes)[free], mass[free])
        shapes[self.free] = kept[:, :number]
        return squares[:number], shapes, mass

    def stands_at_once(self, load, number=5, periods=3):
        """Whether it does not touch under a load ``u -> load per length`` switched on at once, without damping.

        Its lowest modes move for some periods of the first one.
        """
        gap, (squares, shapes, _) = self.beam.gap, self.modes(number)

        def rates(_, state):
            u = shapes @ state[:number]
            force, _ = self.forces(u, lambda v: (load(np.minimum(v, 0.999 * gap)), 0 * v))
            return np.concatenate([state[number:], shapes.T @ force - squares * state[:number]])

        def left(_, state):
            return 0.99 * gap - (shapes @ state[:number])[::2].max()

        left.terminal = True
        time = 2 * np.pi * periods / squares[0] ** 0.5
        found = solve_ivp(rates, (0, time), np.zeros(2 * number), "DOP853", events=left, rtol=1e-6)
        return not len(found.t_events[0])
