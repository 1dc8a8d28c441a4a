#!/usr/bin/env python3
"""Writes the files of this folder again: make_files.py (it needs numpy)."""
import itertools
import random
import shutil
from pathlib import Path

import numpy as np
from program import simulate, write

HERE = Path(__file__).parent
SLIPS = """inertia-kept inertia-product-sign inertia-diagonal inertia-without-E inertia-about-centre
point-left-out:first point-left-out:last top-has-mass top-has-mass:top rim-point-twice rotation-reversed dt-forgotten
axis-not-unit first-order-rotation angle-in-degrees angle-in-degrees:times torque-before-turn L-before-turn L-a-row-late
points-in-place dt-missing-in-torque force-without-mass no-gravity hub-traced columns-swapped torque-reversed gravity-up
torque-of-centre:one torque-of-centre:all torque-sums-up gravity-9.81 gravity-10 L-kept L-turned L-turned:only
L-other-frame tilt-other-axis:-x tilt-other-axis:y tilt-other-axis:-y tilt-other-axis:points tilt-in-radians push-early
push-early:short push-late push-too-long push-too-long:forever push-accumulates another-dt:0.002 rotation-without-E
rotation-without-E:left-out cross-product-sign cross-product-sign:turn start-of-another-preset:push
start-of-another-preset:hub start-of-another-preset:top start-of-another-preset:tilt start-of-another-preset:L
start-of-another-preset:nothing-changed""".split()
# Slips that came later still.
NEW = """torque-about-cm push-reversed push-on-another-point push-on-another-point:lower push-on-another-point:rim
total-mass-on-each total-mass-on-each:inertia dt-squared dt-squared:turn projector-missing inertia-sums-up omega-squared
omega-squared:axis angle-in-turns angle-in-turns:divided omega-along-L omega-along-L:Izz omega-along-L:axle""".split()
# Slips that came later, and are not among the pairs that are drawn.
LATER = ("rotation-without-E", "cross-product-sign")
# Slips that can be told from all others in the report's own set-ups.
OF_THE_REPORT = {
    "method-1": "inertia-without-E inertia-about-centre rotation-reversed torque-before-turn points-in-place no-gravity "
    "torque-of-centre:one dt-missing-in-torque force-without-mass gravity-9.81 gravity-10 torque-sums-up top-has-mass",
    "method-2": "inertia-about-centre point-left-out:last rim-point-twice axis-not-unit first-order-rotation "
    "torque-before-turn L-before-turn L-a-row-late L-other-frame tilt-other-axis:y tilt-in-radians gravity-9.81",
    "wobble-push": "torque-before-turn push-early push-late push-too-long push-accumulates torque-sums-up gravity-up "
    "torque-reversed angle-in-degrees columns-swapped",
}


def file(folder, name, scenario, slips=(), steps=300, every=5, form="%.12g", dtype=np.float64):
    path = HERE / folder / f"{name}.csv"
    path.parent.mkdir(exist_ok=True)
    with path.open("w") as out:
        write(simulate(scenario, steps, every, set(slips), dtype), form, out=out)


def main():
    for folder in [*OF_THE_REPORT, "every-slip", "pairs", "right", "single"]:
        shutil.rmtree(HERE / folder, ignore_errors=True)
    for slip in [*SLIPS, *NEW]:
        # Without E the points fall together: rounding decides from step 3 on.
        steps, every = (60, 1) if slip.startswith("rotation-without-E") else (300, 5)
        file("every-slip", slip.replace(":", "_"), "every-slip", [slip], steps, every)
    for scenario, slips in OF_THE_REPORT.items():
        for slip in slips.split():
            file(scenario, slip.replace(":", "_"), scenario, [slip])
    names = [slip for slip in SLIPS if ":" not in slip and slip not in ("hub-traced", "columns-swapped", *LATER)]
    unlike = [  # one makes the other nothing, or both together are the report's own step
        {"inertia-product-sign", "inertia-diagonal"}, {"inertia-diagonal", "inertia-without-E"}, {"gravity-9.81", "gravity-10"},
        {"push-early", "push-late"}, {"push-early", "push-too-long"}, {"torque-before-turn", "L-before-turn"},
    ]
    over = {"first-order-rotation", "L-kept", "no-gravity", "axis-not-unit"}
    pairs = [
        pair for pair in itertools.combinations(names, 2)
        if set(pair) not in unlike and not over & set(pair)
    ]
    for slip in ("gravity-9.81", "torque-before-turn"):
        file("single", slip, "every-slip", [slip], form="%.9g", dtype=np.float32)
    random.seed(1)
    for pair in [*random.sample(pairs, 30), ("cross-product-sign", "gravity-9.81"), ("start-of-another-preset:push", "dt-forgotten")]:
        file("pairs", "+".join(pair).replace(":", "_"), "every-slip", pair, steps=240, every=3)
    for scenario, steps in [("method-1", 2000), ("method-2", 2300), ("wobble-push", 2300), ("every-slip", 2000)]:
        for kind in "fg":
            for digits in (4, 6, 10, 17):
                file("right", f"{scenario}-{digits}{kind}", scenario, steps=steps, every=steps // 50, form=f"%.{digits}{kind}")
        file("right", f"{scenario}-single", scenario, steps=steps, every=steps // 50, form="%.9g", dtype=np.float32)


if __name__ == "__main__":
    np.seterr(all="ignore")
    main()
