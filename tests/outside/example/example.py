# Ten lines from a scene to numbers and a picture, where the module is found: PYTHONPATH=PREFIX/lib/python3/dist-packages
import numpy as np
import pneuma

world = pneuma.load("pressure_soft", set={"body.k": 20, "duration": 2})
ball = world.soft[0]
while world.time < 1.0:
    world.step()
    height = ball.positions[:, 2].max()
print(f"{height:.3f} m high, {ball.volume:.1f} m^3, {world.energies['kinetic']:.3g} J, {world.state_hash}")
np.save("picture.npy", world.draw(width=320, height=240))
