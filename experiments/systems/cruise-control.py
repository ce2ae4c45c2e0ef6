"""A car with a cruise control on a hilly road, as a system to be tested.

Each line on standard input is a test, `{"index":0,"test":{"set_speed":25,"grade":[0,8,-8,0]}}`; each is answered with
the trace of 60 seconds. The grade in percent is constant over equal parts of that time. The controller adds up what
the speed lacks also while the engine gives all it can: after a long climb it lets go too late. That is the mistake.
"""

import json
import sys

MASS, GRAVITY, DRAG = 1500.0, 9.81, 0.4  # kg, m/s2, N per (m/s)2
PROPORTIONAL, INTEGRAL = 800.0, 60.0  # N per m/s, N per m
MOST_FORCE, MOST_BRAKING = 2500.0, 500.0  # N; the controller brakes by the engine only
STEP, STEPS = 0.1, 600


def drive(set_speed, grade):
    """The trace of a test."""
    speed, lacking = set_speed, 0.0
    trace = {"time": [], "speed": [], "excess": []}
    for step in range(STEPS + 1):
        trace["time"].append(step / 10)
        trace["speed"].append(speed)
        trace["excess"].append(speed - set_speed)
        slope = grade[min(step * len(grade) // STEPS, len(grade) - 1)] / 100
        lacking += (set_speed - speed) * STEP
        wanted = PROPORTIONAL * (set_speed - speed) + INTEGRAL * lacking
        force = min(max(wanted, -MOST_BRAKING), MOST_FORCE)
        force -= MASS * GRAVITY * slope + DRAG * speed * speed
        speed = max(speed + force / MASS * STEP, 0.0)
    return trace


for line in sys.stdin:
    question = json.loads(line)
    answer = {"index": question["index"], "trace": drive(**question["test"])}
    print(json.dumps(answer), flush=True)
