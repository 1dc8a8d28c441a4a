#!/usr/bin/env python3
"""The report's numerical method (its section 3) as a student would write it, with optional mistakes. make_files.py uses it to
produce the files of this folder. It shares no code with gyrolab.

    program.py SCENARIO [--slip NAME[:VARIANT],...] [--steps N] [--every N] [--format %.17g] [--float32] > mine.csv
"""
import argparse
import sys

import numpy as np

R = 0.8
FLAT = R / np.sqrt(2)
# scenario: height of the hub, tilt in degrees, L, whether L is in the body frame, dt, push on the top of the axle, its steps
SCENARIOS = {
    "method-1": (FLAT, 0, (400, 0, 2000), False, 1e-3, (0, 0, 0), 0),
    "method-2": (FLAT, 45, (0, 0, 1000), True, 1e-1, (0, 0, 0), 0),
    "wobble-push": (FLAT, 45, (0, 0, 1000), True, 1e-1, (0, 0, -100), 200),
    "every-slip": (1.0, 30, (5, -3, 60), True, 1e-3, (20, 30, -100), 200),
}


def wheel(h, slips):
    n = 10
    a = 2 * np.pi * np.arange(n) / n
    if "rim-point-twice" in slips:
        a = np.linspace(0, 2 * np.pi, n)
    rim = np.column_stack([R * np.cos(a), R * np.sin(a), h * np.ones(n)])
    hub = 0.9 if h == 1 else h  # every-slip's hub is not at the center of mass
    axle = np.array([[0, 0, hub], [0, 0, 2 * h], [0, 0, 0], [0, 0, h / 2]])
    mass = np.concatenate([0.5 * np.ones(n), np.zeros(4)])
    if "top-has-mass" in slips:
        mass[n:] = 0.5
    if "top-has-mass:top" in slips:
        mass[n + 1] = 0.5
    return np.vstack([rim, axle]), mass


def about(axis, angle):
    c, s = np.cos(angle), np.sin(angle)
    if axis == "x":
        return np.array([[1, 0, 0], [0, c, -s], [0, s, c]])
    return np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])


def start(scenario, slips):
    h, tilt, L, of_body = SCENARIOS[scenario][:4]
    # Values left over from a program for method-1.
    if "start-of-another-preset:tilt" in slips or "start-of-another-preset:nothing-changed" in slips:
        tilt = 0
    if "start-of-another-preset:L" in slips or "start-of-another-preset:nothing-changed" in slips:
        L = (400, 0, 2000)
    X, m = wheel(h, slips)
    if "start-of-another-preset:top" in slips:
        X[-3, 2] = 2 * FLAT
    if "start-of-another-preset:hub" in slips:
        X[:10, 2] = FLAT
    angle = tilt if "tilt-in-radians" in slips else np.deg2rad(tilt)
    axis = "x"
    if "tilt-other-axis:-x" in slips:
        angle = -angle
    if "tilt-other-axis" in slips or "tilt-other-axis:y" in slips:
        axis = "y"
    if "tilt-other-axis:-y" in slips:
        axis, angle = "y", -angle
    Q = about(axis, angle)
    L = np.array(L, dtype=float)
    if of_body != ("L-other-frame" in slips):
        L = Q @ L
    if "tilt-other-axis:points" in slips:
        Q = Q.T
    return X @ Q.T, m, L


def inertia(X, m, slips):
    if "inertia-about-centre" in slips:
        X = X - (m @ X) / m.sum()
    which = range(len(X))
    if "point-left-out" in slips or "point-left-out:first" in slips:
        which = range(1, len(X))
    if "point-left-out:last" in slips:
        which = [k for k in which if k != 9]
    if "total-mass-on-each:inertia" in slips:
        m = np.where(m > 0, m.sum(), m).astype(X.dtype)
    I = np.zeros((3, 3), dtype=X.dtype)
    for k in which:
        r = X[k]
        E = np.ones((3, 3)) if "inertia-without-E" in slips else np.eye(3)
        I = I + m[k] * ((r @ r) * E.astype(X.dtype) - np.outer(r, r))
    if "inertia-product-sign" in slips:
        I = 2 * np.diag(np.diag(I)) - I
    if "inertia-diagonal" in slips:
        I = np.diag(np.diag(I))
    return I


def turn(X, Omega, dt, slips):
    one = X.dtype.type
    if "dt-forgotten" in slips:
        dt = one(1)
    if "dt-squared:turn" in slips:
        dt = dt * dt
    if "first-order-rotation" in slips:
        return X + dt * np.cross(Omega, X), np.eye(3, dtype=X.dtype)
    w = np.sqrt(Omega @ Omega)
    if w == 0:
        return X, np.eye(3, dtype=X.dtype)
    u = Omega if "axis-not-unit" in slips else Omega / w
    if "omega-squared" in slips:
        w = Omega @ Omega
    if "omega-squared:axis" in slips:
        w = Omega @ Omega
        u = Omega / w
    P = np.outer(u, u)
    E = np.eye(3, dtype=X.dtype)
    if "rotation-without-E" in slips:  # 1 - P
        E = np.ones((3, 3), dtype=X.dtype)
    if "rotation-without-E:left-out" in slips:
        E = np.zeros((3, 3), dtype=X.dtype)
    C = np.array([[0, -u[2], u[1]], [u[2], 0, -u[0]], [-u[1], u[0], 0]], dtype=X.dtype)
    angle = w * dt
    if "angle-in-degrees" in slips:  # cosd, sind
        angle = angle * one(np.pi / 180)
    if "angle-in-degrees:times" in slips:
        angle = angle * one(180 / np.pi)
    if "angle-in-turns" in slips:
        angle = angle * one(2 * np.pi)
    if "angle-in-turns:divided" in slips:
        angle = angle / one(2 * np.pi)
    if "cross-product-sign:turn" in slips:
        C[1] = -C[1]
    Rot = P + np.cos(angle) * (E - P) + np.sin(angle) * C
    if "projector-missing" in slips:
        Rot = np.cos(angle) * (E - P) + np.sin(angle) * C
    if "rotation-reversed" in slips:
        Rot = Rot.T
    if "points-in-place" in slips:
        X = X.copy()
        for i in range(3):
            X[:, i] = Rot[i, 0] * X[:, 0] + Rot[i, 1] * X[:, 1] + Rot[i, 2] * X[:, 2]
        return X, Rot
    return (Rot @ X.T).T, Rot


def push_factor(clock, steps, slips):
    """How many times the push acts on step `clock` (1 is the first), whose t is clock*dt."""
    nth = clock
    if "push-late" in slips:
        nth = clock - 1
    if "push-early" in slips:
        nth = clock + 1
    if "push-accumulates" in slips:
        return max(min(nth, steps), 0)
    if "push-early:short" in slips:
        steps = steps - 1
    if "start-of-another-preset:push" in slips or "start-of-another-preset:nothing-changed" in slips:
        return 0
    last = steps + 1 if "push-too-long" in slips else steps
    if "push-too-long:forever" in slips:
        last = 10**9
    return 1 if steps > 0 and 0 < nth <= last else 0


def torque(X, m, push, clock, steps, slips):
    one = X.dtype.type
    g = 9.8
    g = 9.81 if "gravity-9.81" in slips else g
    g = 10.0 if "gravity-10" in slips else g
    g = 0.0 if "no-gravity" in slips else g
    g = -g if "gravity-up" in slips else g
    n = len(X)
    top = n - 3
    F = np.zeros((n, 3), dtype=X.dtype)
    F[:, 2] = -one(g) if "force-without-mass" in slips else -m * one(g)
    if "total-mass-on-each" in slips or "total-mass-on-each:inertia" in slips:
        F[:, 2] = np.where(m > 0, -m.sum() * one(g), 0)
    P = push * one(push_factor(clock, steps, slips))
    if "push-reversed" in slips:
        P = -P
    for slip, place in [("", n - 4), (":foot", n - 2), (":lower", n - 1), (":rim", 0)]:
        if "push-on-another-point" + slip in slips:
            top = place
    r = X
    centre = (m @ X) / m.sum()
    if "torque-of-centre" in slips or "torque-of-centre:one" in slips:
        F[:] = 0
        F[top] = P
        tau = np.cross(r, F).sum(axis=0) + np.cross(centre, np.array([0, 0, -one(0.5 * g)], dtype=X.dtype))
    elif "torque-of-centre:all" in slips:
        F[top] += P
        tau = np.cross(centre, F.sum(axis=0))
    else:
        F[top] += P
        tau = np.cross(r, F).sum(axis=0)
    if "torque-about-cm" in slips:
        tau = np.cross(r - centre, F).sum(axis=0)
    if "cross-product-sign" in slips:
        tau = tau * np.array([1, -1, 1], dtype=X.dtype)
    if "point-left-out:first" in slips:  # the weight too
        tau = tau - np.cross(r[0], F[0])
    return -tau if "torque-reversed" in slips else tau


def simulate(scenario, steps, every, slips, dtype=np.float64):
    push, push_steps = SCENARIOS[scenario][5:]
    dt = dtype(SCENARIOS[scenario][4])
    for slip in slips:
        if slip.startswith("another-dt:"):
            dt = dtype(float(slip.split(":")[1]))
    X, m, L = (a.astype(dtype) for a in start(scenario, slips))
    push = np.array(push, dtype=dtype)
    shown = len(X) - 4 if "hub-traced" in slips else len(X) - 3
    all_inertia = np.zeros((3, 3), dtype=dtype)
    earlier, I0, total = L, inertia(X, m, slips), np.zeros(3, dtype=dtype)

    def row(clock):
        x, y, z = X[shown]
        if "columns-swapped" in slips:
            x, y = y, x
        l = earlier if "L-a-row-late" in slips else L
        return [clock, clock * float(dt), x, y, z, *l]

    rows = [row(0)]
    for clock in range(1, steps + 1):
        earlier = L

        def kick(L, X):
            nonlocal total
            tau = torque(X, m, push, clock, push_steps, slips)
            if "torque-sums-up" in slips:
                total = total + tau
                tau = total
            if "L-kept" in slips:
                return L
            if "dt-squared" in slips:
                return L + dt * dt * tau
            return L + (tau if "dt-missing-in-torque" in slips else dt * tau)

        if "L-before-turn" in slips:
            L = kick(L, X)
        I = I0 if "inertia-kept" in slips else inertia(X, m, slips)
        if "inertia-sums-up" in slips:
            all_inertia = all_inertia + I
            I = all_inertia
        try:
            Omega = np.linalg.solve(I, L)
        except np.linalg.LinAlgError:  # the slip has shrunk the body to nothing
            break
        if "omega-along-L" in slips:
            Omega = L * np.sqrt((Omega @ Omega) / (L @ L))
        if "omega-along-L:Izz" in slips:
            Omega = L / I[2, 2]
        if "omega-along-L:axle" in slips:
            axle = X[-3] / np.sqrt(X[-3] @ X[-3])
            Omega = L / (axle @ I @ axle)
        before = X
        X, Rot = turn(X, Omega, dt, slips)
        if "L-turned" in slips:
            L = Rot @ L
        if "L-turned:only" in slips:
            L = Rot @ L
        elif "torque-before-turn" in slips:
            L = kick(L, before)
        elif "L-before-turn" not in slips:
            L = kick(L, X)
        if not np.all(np.isfinite(X)):
            break
        if clock % every == 0:
            rows.append(row(clock))
    return rows


def write(rows, form="%.17g", names="step,t_s,x_m,y_m,z_m,Lx_Js,Ly_Js,Lz_Js", out=sys.stdout):
    print(names, file=out)
    for row in rows:
        print("%d," % row[0] + ",".join(form % float(value) for value in row[1:]), file=out)


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("scenario", choices=SCENARIOS)
    parser.add_argument("--slip", default="")
    parser.add_argument("--steps", type=int, default=300)
    parser.add_argument("--every", type=int, default=1)
    parser.add_argument("--format", default="%.17g")
    parser.add_argument("--float32", action="store_true")
    args = parser.parse_args()
    slips = set(args.slip.split(",")) - {""}
    dtype = np.float32 if args.float32 else np.float64
    np.seterr(all="ignore")
    write(simulate(args.scenario, args.steps, args.every, slips, dtype), args.format)
