"""`import pneuma`: what it reads is the command's own, bit by bit. argv: the folder of the module, the program."""

import gc
import json
import pathlib
import struct
import subprocess
import sys
import tempfile
import threading
import unittest
import zlib

import numpy as np

MODULE_FOLDER, PROGRAM = sys.argv[1:3]
sys.path.insert(0, MODULE_FOLDER)
import pneuma  # noqa: E402

SCENE = """
duration = 0.7
[picture]
width = 64
height = 48
samples = 1
[[body]]
name = "ball"
radius = 1.0
position = [0.0, 0.0, 1.05]
[[body]]
name = "box"
kind = "rigid"
position = [3.0, 0.0, 1.05]
"""

KINDS = """
[[body]]
kind = "static"
size = [9, 9, 1]
position = [0, 0, 0.5]
[[body]]
kind = "rigid"
position = [0, 0, 3]
[[body]]
kind = "static"
shape = "icosphere"
radius = 1
position = [20, 0, 2]
[[body]]
radius = 1
position = [10, 0, 2]
copies = [1, 2, 1]
spacing = [0, 4, 0]
[[body]]
kind = "moved"
size = [1, 1, 1]
velocity = [0, 0, 0]
position = [30, 0, 2]
"""


def decoded_png(path):
    """8-bit RGB without interlacing (the PNG specification, section 9), by other code than the program's."""
    data = path.read_bytes()
    at, pixels = 8, b""
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at : at + 8])
        body = data[at + 8 : at + 8 + length]
        if kind == b"IHDR":
            width, height, depth, colour = struct.unpack(">IIBB", body[:10])
            assert (depth, colour) == (8, 2)
        if kind == b"IDAT":
            pixels += body
        at += 12 + length
    rows = np.frombuffer(zlib.decompress(pixels), np.uint8).reshape(height, 1 + 3 * width)
    image = np.zeros((height, width * 3), np.uint8)
    for y in range(height):
        line, above = rows[y, 1:].astype(int), image[y - 1].astype(int) if y else np.zeros(width * 3, int)
        for x in range(3 * width):
            left, corner = (int(image[y, x - 3]), int(above[x - 3])) if x >= 3 else (0, 0)
            up = int(above[x])
            guess = left + up - corner
            paeth = min((abs(guess - v), i, v) for i, v in enumerate((left, up, corner)))[2]
            image[y, x] = (line[x] + (0, left, up, (left + up) // 2, paeth)[rows[y, 0]]) % 256
    return image.reshape(height, width, 3)


class Module(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.scene = self.folder / "ball.toml"
        self.scene.write_text(SCENE)

    def command(self, *arguments):
        return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True, check=False)

    def checked_run(self, *arguments):
        said = self.command("check", self.scene, "--run", "--json", *arguments)
        return json.loads(said.stdout)["run"]

    def test_a_run_ends_in_the_commands_state(self):
        for override in ("body.k=80", "simulation.integrator=rk4", "simulation.contact=impulses"):
            run = self.checked_run("--set", override)
            world = pneuma.load(str(self.scene), set=[override])
            world.step(run["steps"])
            self.assertEqual(world.state_hash, run["state_hash"])
            self.assertEqual(world.energies["total"], run["energy_J"]["end"]["total"])
            self.assertEqual(world.soft[0].volume, run["volumes_m3"][0]["end"])
            self.assertEqual(world.time, run["seconds"])

    def test_steps_are_divided_as_the_commands(self):
        thrown = "body.1.velocity=[0, 0, -200]"
        run = self.checked_run("--set", thrown)
        self.assertGreater(run["divided_steps"], 0)
        world = pneuma.load(str(self.scene), set=[thrown])
        world.step(run["steps"])
        self.assertEqual(world.state_hash, run["state_hash"])

    def test_overrides_are_a_dict_or_a_list(self):
        as_list = pneuma.load(str(self.scene), set=["body.k=80", "picture.caption=false"])
        as_dict = pneuma.load(str(self.scene), set={"body.k": 80, "picture.caption": False})
        self.assertEqual(as_list.scene_toml, as_dict.scene_toml)
        self.assertIn("k = 80", as_dict.scene_toml)

    def loaded(self, overrides):
        return pneuma.load(self.scene, set=overrides).scene_toml

    def test_values_of_overrides_are_pythons_and_numpys(self):
        texts = ["ball.velocity=[1, 2.5, 3]", "duration=0.5", "picture.width=32", "picture.caption=false"]
        expected = self.loaded(texts)
        vectors = ([1, 2.5, 3], (1, 2.5, 3), np.array([1, 2.5, 3]), (np.int8(1), np.float32(2.5), np.int64(3)))
        for vector in vectors:
            for half, width, no in ((0.5, 32, False), (np.float64(0.5), np.int64(32), np.bool_(False))):
                values = {"ball.velocity": vector, "duration": half, "picture.width": width, "picture.caption": no}
                self.assertEqual(self.loaded(values), expected)
        self.assertEqual(self.loaded({"duration": np.array(0.5)}), self.loaded({"duration": 0.5}))
        self.assertEqual(self.loaded({"simulation.integrator": "rk4"}), self.loaded(["simulation.integrator=rk4"]))
        self.assertEqual(self.loaded({"ball.colours": ("#d62828",)}), self.loaded(["ball.colours=['#d62828']"]))
        rows = np.array([[-1, -1, 0, 1, 1, 0.5], [-1, -1, 1.5, 1, 1, 3]])
        self.assertEqual(self.loaded({"ball.pinned": rows}), self.loaded([f"ball.pinned={rows.tolist()}"]))

    def test_dicts_within_overrides_are_tables(self):
        simulation = {"contact": "impulses", "particles": {"max_sweeps": 3}}
        nested = {"ball": {"k": 80}, "body": {2: {"mass": 3}}, "simulation": simulation}
        flat = {"ball.k": 80, "body.2.mass": 3, "simulation.contact": "impulses"}
        flat["simulation.particles.max_sweeps"] = 3
        self.assertEqual(self.loaded(nested), self.loaded(flat))

    def test_other_overrides_are_refused_with_what_is_allowed(self):
        for given in ("body.k=200", 5, b"body.k=200", [5], {5.5: 1}, {"body.k=200"}):
            with self.assertRaisesRegex(TypeError, r'set: expected a dict, such as {"body.k": 200}, or a list'):
                self.loaded(given)
        for value in (None, {1, 2}, [{"k": 1}], object(), b"200"):
            with self.assertRaisesRegex(TypeError, "set: body.k: expected a number, a bool, a str"):
                self.loaded({"body.k": value})
        with self.assertRaisesRegex(pneuma.SceneError, "k: expected a number"):
            self.loaded({"body.k": (1, 2)})

    def test_a_scene_may_be_a_path(self):
        self.assertEqual(pneuma.load(self.scene).state_hash, pneuma.load(str(self.scene)).state_hash)
        with self.assertRaises(TypeError):
            pneuma.load(5)

    def test_threads_are_those_of_the_command(self):
        self.assertEqual(len(pneuma.load(self.scene, threads=2).soft), 1)
        for threads in (-1, 0, 257, 1000):
            with self.assertRaisesRegex(pneuma.UsageError, f"threads = {threads}: .* 1 to 256"):
                pneuma.load(self.scene, threads=threads)
        # The parser's versions word the range otherwise.
        refusal = self.command("check", self.scene, "--threads", "257").stderr
        self.assertRegex(refusal, "1 to 256|\\[1 - 256\\]")

    def test_representations_say_what_there_is(self):
        world = pneuma.load(self.scene)
        self.assertEqual(repr(world), "<pneuma.World 'ball': 1 soft body, 1 rigid box, 60 steps per second>")
        ball = world.soft[0]
        counts = f"{len(ball.positions)} vertices, {len(ball.triangles)} triangles"
        self.assertEqual(repr(ball), f"<pneuma.SoftBody 'ball': {counts}>")
        self.assertEqual(repr(world.rigid[0]), "<pneuma.RigidBox 'box': 2 x 2 x 2 m>")

    def test_bodies_say_their_kind_as_the_scene_does(self):
        with tempfile.TemporaryDirectory() as folder:
            scene = pathlib.Path(folder) / "kinds.toml"
            scene.write_text(KINDS)
            world = pneuma.load(scene)
        self.assertEqual([body.kind for body in world.soft], ["static", "soft", "soft"])
        self.assertEqual([body.kind for body in world.rigid], ["static", "rigid", "moved"])
        with self.assertRaises(AttributeError):
            world.soft[0].kind = "soft"

    def test_volume_and_energy_are_those_of_the_arrays(self):
        world = pneuma.load(str(self.scene), set={"body.1.rho_g": 0})
        world.step(20)
        ball = world.soft[0]
        a, b, c = (ball.positions[ball.triangles[:, i]] for i in range(3))
        volume = np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6  # Gauss's theorem
        self.assertAlmostEqual(ball.volume / volume, 1.0, places=12)
        box = world.rigid[0]
        self.assertEqual(box.position.shape, (3,))
        self.assertAlmostEqual(np.linalg.norm(box.orientation), 1.0, places=12)

    def test_arrays_of_the_state_are_copies_and_triangles_stay(self):
        world = pneuma.load(str(self.scene))
        ball = world.soft[0]
        before, triangles = ball.positions, ball.triangles
        kept = before.copy()
        world.step(3)
        np.testing.assert_array_equal(before, kept)
        self.assertFalse(np.array_equal(before, ball.positions))
        before[:] = 0.0
        ball.velocities[:] = 1e9
        self.assertLess(np.abs(ball.velocities).max(), 1e3)
        with self.assertRaises(ValueError):
            triangles[0, 0] = 1
        content = triangles.copy()
        del world, ball
        gc.collect()
        junk = [np.zeros_like(content) for _ in range(100)]
        np.testing.assert_array_equal(triangles, content)
        self.assertEqual(len(junk), 100)

    def test_a_body_outlives_the_name_of_its_world(self):
        ball = pneuma.load(str(self.scene)).soft[0]
        gc.collect()
        self.assertEqual(ball.positions.shape[1], 3)

    def test_contacts_name_their_bodies(self):
        world = pneuma.load(str(self.scene))
        self.assertEqual(len(world.contacts["kind"]), 0)
        while world.steps < 60 and not len(world.contacts["kind"]):
            world.step()
        contacts = world.contacts
        count = len(contacts["kind"])
        self.assertGreater(count, 0)
        self.assertEqual(contacts["point"].shape, (count, 3))
        np.testing.assert_allclose(np.linalg.norm(contacts["normal"], axis=1), 1.0, rtol=1e-12)
        for kind, (_, second), normal in zip(contacts["kind"], contacts["bodies"], contacts["normal"]):
            self.assertEqual(kind.endswith("_ground"), second == "the ground")
            if second == "the ground":
                np.testing.assert_allclose(normal, [0, 0, 1], atol=1e-12)

    def test_a_picture_is_the_commands_frame(self):
        out = self.folder / "out"
        self.assertEqual(self.command("render", self.scene, "--out", out, "--frames", "6-6").returncode, 0)
        world = pneuma.load(str(self.scene))
        world.step(6 * world.steps_per_second // 30)
        image = world.draw()
        self.assertEqual((image.shape, image.dtype), ((48, 64, 3), np.uint8))
        np.testing.assert_array_equal(image, decoded_png(out / "ball_00006.png"))
        self.assertEqual(world.draw(width=32, height=16).shape, (16, 32, 3))
        pictures = []
        thread = threading.Thread(target=lambda: pictures.append(world.draw()))
        thread.start()
        thread.join()
        np.testing.assert_array_equal(pictures[0], image)

    def test_errors_have_the_commands_text(self):
        broken = self.folder / "broken.toml"
        broken.write_text(SCENE.replace("radius = 1.0", "radius = -1.0"))
        said = self.command("check", broken)
        self.assertEqual(said.returncode, 3)
        with self.assertRaises(pneuma.SceneError) as caught:
            pneuma.load(str(broken))
        self.assertEqual(str(caught.exception) + "\n", said.stderr)
        with self.assertRaises(pneuma.SceneError):
            pneuma.load("no_such_scene")
        with self.assertRaises(pneuma.Error):
            pneuma.load(str(self.scene)).draw(width=1)

    def test_warnings_are_the_commands_before_a_run(self):
        much_gas = "ball.n=200"
        said = self.command("check", self.scene, "--set", much_gas).stderr
        world = pneuma.load(self.scene, set=[much_gas])
        world.step(5)
        self.assertTrue(any("warning: body 'ball'" in warning for warning in world.warnings), said)
        self.assertEqual("\n".join(world.warnings) + "\n", said)

    def test_a_divergence_leaves_the_last_valid_state(self):
        far = ["simulation.integrator=symplectic_euler", "body.1.k=1e12", "body.1.k_max=8e12"]
        far.append("simulation.steps_per_second=60")
        said = self.command("check", self.scene, "--run", *(w for o in far for w in ("--set", o)))
        self.assertEqual(said.returncode, 5)
        world = pneuma.load(str(self.scene), set=far)
        with self.assertRaises(pneuma.DivergenceError) as caught:
            world.step(1000)
        self.assertIn(str(caught.exception), said.stderr)
        self.assertTrue(np.isfinite(world.soft[0].positions).all())

    def test_two_threads_step_two_worlds(self):
        worlds = [pneuma.load(str(self.scene)) for _ in range(2)]
        threads = [threading.Thread(target=world.step, args=(42,)) for world in worlds]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(worlds[0].state_hash, worlds[1].state_hash)
        self.assertEqual(worlds[0].steps, 42)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
