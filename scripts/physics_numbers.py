"""Prints how exact the plant is: `python scripts/physics_numbers.py`."""

from hilbed.plant import checks

roll = checks.rolling()
print(f"rolling     distance {roll.distance:+.4%}, yaw {roll.yaw:+.4%}            (limit 0.05 %)")
for friction in (0.15, 0.3, 0.8):
    print(
        f"slip onset  {checks.slip_onset(friction):+.2%} of Coulomb at mu = {friction}          (limit 2 %)"
    )
speed, current = checks.motor_step()
print(f"motor step  speed {speed:.4%}, current {current:.4%}               (limit 0.5 %)")
books = checks.energy()
parts = ", ".join(f"{name} {value:.3f}" for name, value in books._asdict().items())
print(f"energy      {books.error:+.3%} unaccounted for                   (limit 1 %)\n            J: {parts}")
