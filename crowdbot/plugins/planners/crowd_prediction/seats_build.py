"""Compiled parts of `CrowdForecast`: assign people to simulated agents ("seats"), read results."""

from __future__ import annotations

import math

import numpy as np

from crowdbot.plugin import Array, Indices, Mask, array_kernel, kernel

#: Where people are put who take no part, m.
_AWAY = 1e6
#: Distance of the goals of people, m.
_FAR = 20.0


@array_kernel
def seated(
    people: Array, desired: Array, here: Array, slowest: float, most: int, speeds: Array
) -> tuple[tuple[Array, Array, Array, Mask], Indices, Array]:
    """Assign walking people, nearest first, to free simulated agents of the nearest speed.

    Args:
        people: (N, 5) x, y, vx, vy, radius; m, m/s.
        desired: (N, 2) velocity, m/s; who wants less than ``slowest`` stands.
        here: (2,) place of the robot, m.
        slowest: m/s.
        most: how many people take part.
        speeds: (S,) of the seats, m/s, at least ``most``.

    Returns:
        Place, velocity and goal (S, 2) of each seat, and if it is taken (S,); the seat of each
        person (N,), -1 for none; and what they want beyond the speed of the seat (N, 2), m/s.
    """
    count, size = people.shape[0], speeds.shape[0]
    place, velocity = np.full((size, 2), _AWAY), np.zeros((size, 2))
    goal, present = np.full((size, 2), _AWAY + 1.0), np.zeros(size, np.bool_)
    seats, slips, away = np.full(count, -1), np.zeros((count, 2)), np.empty(count)
    for i in range(count):
        x, y = people[i, 0] - here[0], people[i, 1] - here[1]
        away[i] = x * x + y * y
        if math.hypot(desired[i, 0], desired[i, 1]) < slowest:
            away[i] = math.inf
    for _ in range(min(most, count)):
        i = int(np.argmin(away))
        if away[i] == math.inf:
            break
        away[i] = math.inf
        speed = math.hypot(desired[i, 0], desired[i, 1])
        seat = _free_seat(speed, speeds, present)
        seats[i], present[seat] = seat, True
        for c in range(2):
            place[seat, c], velocity[seat, c] = people[i, c], people[i, 2 + c]
            goal[seat, c] = people[i, c] + _FAR * desired[i, c] / speed
            slips[i, c] = (1.0 - speeds[seat] / speed) * desired[i, c]
    return (place, velocity, goal, present), seats, slips


@kernel
def _free_seat(speed: float, speeds: Array, taken: Mask) -> int:
    best, least = 0, math.inf
    for k in range(speeds.shape[0]):
        off = abs(speeds[k] - speed)
        if off < least and not taken[k]:
            best, least = k, off
    return best


@kernel
def leave_seats(
    places: Array, speeds: Array, pulls: Array, seats: Indices, slips: Array,
    times: tuple[float, int], out: Array,
) -> None:  # fmt: skip
    """Write the positions of people with a simulated agent after each step; leave others as is.

    After the last decision they keep their velocity.

    Args:
        places, speeds, pulls: (K, S, 2) at each decision, SI units.
        seats, slips: (N,), (N, 2) of `seated`.
        times: length of a step, s, and steps between two decisions.
        out: (T, N, 2), m.
    """
    step, each = times
    dt, last = each * step, places.shape[0] - 1
    for k in range(out.shape[0]):
        d, since = k // each, (k % each + 1) / each
        for i in range(seats.shape[0]):
            seat = seats[i]
            if seat < 0:
                continue
            for c in range(2):
                if d > last:
                    after = speeds[last, seat, c] + dt * pulls[last, seat, c]
                    out[k, i, c] = out[k - 1, i, c] + step * (after + slips[i, c])
                    continue
                middle = speeds[d, seat, c] + 0.5 * since * dt * pulls[d, seat, c]
                moved = places[d, seat, c] + since * dt * middle
                out[k, i, c] = moved + step * (k + 1) * slips[i, c]


@kernel
def settle(
    numbers: Indices, people: Array, before: Indices, desired: Array, fresh: float, out: Array
) -> None:
    """Write the wanted velocities (N, 2): what was wanted before moves towards the present, m/s.

    Args:
        numbers, people: (N,), (N, 5) as in `CrowdForecast.predict`.
        before, desired: (M,), (M, 2) numbers of people and what they wanted.
        fresh: share of the present, 0 to 1.
    """
    for i in range(numbers.shape[0]):
        out[i, 0], out[i, 1] = people[i, 2], people[i, 3]
        for j in range(before.shape[0]):
            if before[j] == numbers[i]:
                for c in range(2):
                    out[i, c] = desired[j, c] + fresh * (people[i, 2 + c] - desired[j, c])
                break


@kernel
def mean_errors(
    numbers: Indices, people: Array, due: Indices, kept: Array, crowd: Array
) -> tuple[int, float, float]:
    """Return the number of predicted people still present, and the mean square errors, m^2.

    Args:
        numbers, people: (N,), (N, 5) people now.
        due: (M,) numbers of those predicted.
        kept, crowd: (M, 2) two predictions of where they would be now.
    """
    count, off, other = 0, 0.0, 0.0
    for i in range(numbers.shape[0]):
        for j in range(due.shape[0]):
            if due[j] == numbers[i]:
                x, y = kept[j, 0] - people[i, 0], kept[j, 1] - people[i, 1]
                off += x * x + y * y
                x, y = crowd[j, 0] - people[i, 0], crowd[j, 1] - people[i, 1]
                other += x * x + y * y
                count += 1
                break
    return count, off / max(count, 1), other / max(count, 1)
