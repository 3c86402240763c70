"""What Blender runs for scripts/cycles-picture: a mesh file and a run's camera to a picture by Cycles, and what our
picture's luminance is beside it.

Light is that of render/light/environment.h and render/frame/frame.h.
"""
import json
import math
import os
import sys

import bpy
import mathutils
import numpy

numpy.bool = bool  # which Blender 3.4's glTF reader still asks of Debian's NumPy

mesh_file, record_file, size, samples, picture_file, our_file = sys.argv[sys.argv.index("--") + 1:]
width, height = (int(side) for side in size.split("x"))
with open(record_file, encoding="utf-8") as file:
    camera_of_run = json.load(file)["frames"][0]["camera"]

CONTACT_REACH = 0.1  # of the bodies' mean size
FAR = 60.0  # mean sizes: what is further away is the horizon
ROUGHNESS = 0.35  # of bodies, which the mesh file does not hold
LUMINANCE = (0.2126, 0.7152, 0.0722)
SUN = (0.95, 0.90, 0.80)
ZENITH = (0.36, 0.42, 0.53)
HORIZON = (0.58, 0.60, 0.63)
FLOOR = (0.60, 0.60, 0.58)  # radiance of the open, lit ground
SUN_DIRECTION = mathutils.Vector((-0.45, 0.35, -0.82)).normalized()


def colour(rgb):
    return (*rgb, 1.0)


class Rounded:
    """A smooth body as render/geometry/rounding.h draws it, but for what keeps bodies apart: each triangle in 16, their
    points moved half way towards the tangent planes of its corners."""

    PARTS = 4
    WEIGHTS = [(i, j, 4 - i - j) for i in range(5) for j in range(5 - i)]

    def __init__(self, body):
        self.coarse = body.data
        self.coarse.calc_loop_triangles()
        self.x = numpy.array([vertex.co for vertex in self.coarse.vertices])
        self.n = numpy.array([vertex.normal for vertex in self.coarse.vertices])
        self.colours = self.colours_by_vertex()
        self.points, self.faces = {}, []  # by corners and their weights: number, place, colour
        for triangle in self.coarse.loop_triangles:
            self.divide(list(triangle.vertices))

    def colours_by_vertex(self):
        layer = self.coarse.color_attributes[0]
        values = numpy.array([value.color for value in layer.data])
        if layer.domain == "POINT":
            return values
        colours = numpy.zeros((len(self.x), 4))
        colours[[loop.vertex_index for loop in self.coarse.loops]] = values
        return colours

    def point(self, triangle, weights):
        key = tuple(sorted(pair for pair in zip(triangle, weights) if pair[1] > 0))
        if key not in self.points:
            w = numpy.array(weights) / self.PARTS
            place = w @ self.x[triangle]
            heights = numpy.sum((self.x[triangle] - place) * self.n[triangle], axis=1)
            place = place + 0.5 * (w * heights) @ self.n[triangle]
            self.points[key] = (len(self.points), place, w @ self.colours[triangle])
        return self.points[key][0]

    def divide(self, triangle):
        at = {weights: self.point(triangle, weights) for weights in self.WEIGHTS}
        for i, j, k in self.WEIGHTS:
            if k > 0:
                self.faces.append([at[i, j, k], at[i + 1, j, k - 1], at[i, j + 1, k - 1]])
            if k > 1:
                self.faces.append([at[i + 1, j, k - 1], at[i + 1, j + 1, k - 2], at[i, j + 1, k - 1]])

    def mesh(self):
        fine = bpy.data.meshes.new(self.coarse.name + " rounded")
        fine.from_pydata([place for _, place, _ in self.points.values()], [], self.faces)
        layer = fine.color_attributes.new(self.coarse.color_attributes[0].name, "FLOAT_COLOR", "POINT")
        layer.data.foreach_set("color", numpy.array([c for _, _, c in self.points.values()]).ravel())
        fine.polygons.foreach_set("use_smooth", [True] * len(self.faces))
        fine.materials.append(self.coarse.materials[0])
        return fine


def add_bodies():
    bpy.ops.import_scene.gltf(filepath=mesh_file)
    for material in bpy.data.materials:
        if material.use_nodes:
            material.node_tree.nodes["Principled BSDF"].inputs["Roughness"].default_value = ROUGHNESS
    for body in [one for one in bpy.context.scene.objects if one.type == "MESH"]:
        body.pass_index = 1
        if len(body.data.vertices) > 24:
            body.data = Rounded(body).mesh()


def ground_albedo():
    """With which a matt plane under sun and sky, whose radiance is z (2 - z) of the way from horizon to zenith, shows
    the radiance of FLOOR: 2 times the integral of z z (2 - z) over z is 5/6."""
    facing = -SUN_DIRECTION.z
    return [floor / (facing * sun + horizon + (zenith - horizon) * 5.0 / 6.0)
            for floor, sun, horizon, zenith in zip(FLOOR, SUN, HORIZON, ZENITH)]


def add_ground():
    bpy.ops.mesh.primitive_plane_add(size=2000.0)
    ground = bpy.context.object
    ground.name = "ground"
    material = bpy.data.materials.new("ground")
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    shader = nodes.new("ShaderNodeBsdfDiffuse")
    shader.inputs["Color"].default_value = colour(ground_albedo())
    links.new(shader.outputs["BSDF"], nodes["Material Output"].inputs["Surface"])
    ground.data.materials.append(material)


def add_sun():
    light = bpy.data.lights.new("sun", "SUN")
    light.energy = math.pi * max(SUN)  # W/m^2: a white, matt surface that faces it then shows its radiance
    light.color = tuple(part / max(SUN) for part in SUN)
    light.angle = math.radians(2.0)
    sun = bpy.data.objects.new("sun", light)
    sun.rotation_euler = SUN_DIRECTION.to_track_quat("-Z", "Y").to_euler()
    bpy.context.scene.collection.objects.link(sun)


def add_sky():
    world = bpy.data.worlds.new("sky")
    world.use_nodes = True
    nodes, links = world.node_tree.nodes, world.node_tree.links
    where = nodes.new("ShaderNodeTexCoord")
    parts = nodes.new("ShaderNodeSeparateXYZ")
    ramp = nodes.new("ShaderNodeValToRGB")
    ramp.color_ramp.elements[0].color = colour(HORIZON)
    ramp.color_ramp.elements[1].color = colour(ZENITH)
    # z (2 - z), in four straight pieces.
    for z in (0.25, 0.5, 0.75):
        part = z * (2.0 - z)
        mixed = [a + (b - a) * part for a, b in zip(HORIZON, ZENITH)]
        ramp.color_ramp.elements.new(z).color = colour(mixed)
    links.new(where.outputs["Generated"], parts.inputs[0])
    links.new(parts.outputs["Z"], ramp.inputs["Fac"])
    links.new(ramp.outputs["Color"], nodes["Background"].inputs["Color"])
    bpy.context.scene.world = world


def add_camera():
    camera = bpy.data.cameras.new("camera")
    camera.sensor_fit = "VERTICAL"
    camera.angle = math.radians(camera_of_run["field_of_view"])
    camera.clip_end = 10000.0
    placed = bpy.data.objects.new("camera", camera)
    eye, target = (mathutils.Vector(camera_of_run[name]) for name in ("eye", "target"))
    placed.location = eye
    placed.rotation_euler = (target - eye).to_track_quat("-Z", "Y").to_euler()
    bpy.context.scene.collection.objects.link(placed)
    bpy.context.scene.camera = placed


def body_size():
    """Mean diagonal of the bodies' boxes, m."""
    bodies = [one for one in bpy.context.scene.objects if one.type == "MESH" and one.name != "ground"]
    sides = [numpy.ptp([one.matrix_world @ mathutils.Vector(corner) for corner in one.bound_box], axis=0)
             for one in bodies]
    return float(numpy.mean(numpy.linalg.norm(sides, axis=1)))


def write_passes(folder, contact_reach):
    """Each pass as a float picture of its own: a file with several layers is closed to Blender's Python."""
    scene = bpy.context.scene
    layer = scene.view_layers[0]
    layer.use_pass_shadow = layer.use_pass_ambient_occlusion = True
    layer.use_pass_z = layer.use_pass_object_index = True
    scene.world.light_settings.distance = contact_reach
    scene.use_nodes = True
    file = scene.node_tree.nodes.new("CompositorNodeOutputFile")
    file.base_path = folder
    file.format.file_format, file.format.color_depth = "OPEN_EXR", "32"
    file.file_slots.clear()
    for output in ("Shadow", "AO", "Depth", "IndexOB"):
        file.file_slots.new(output)
        scene.node_tree.links.new(scene.node_tree.nodes["Render Layers"].outputs[output], file.inputs[-1])


def pixels(path):
    image = bpy.data.images.load(path)
    image.colorspace_settings.name = "Non-Color"
    values = numpy.array(image.pixels[:], dtype=numpy.float32)
    return values.reshape(image.size[1], image.size[0], 4)[:, :, :3]


def luminance(path):
    shown = pixels(path)
    linear = numpy.where(shown <= 0.04045, shown / 12.92, ((shown + 0.055) / 1.055) ** 2.4)
    return linear @ numpy.array(LUMINANCE)


def print_regions(folder, size_of_bodies):
    def one_pass(name):
        return pixels(os.path.join(folder, f"{name}0001.exr"))[:, :, 0]

    shadow = (one_pass("Shadow") < 0.5) & (one_pass("Depth") < FAR * size_of_bodies)
    regions = {"shadow": shadow, "contact": shadow & (one_pass("AO") < 0.5)}
    of_body = one_pass("IndexOB") > 0.5
    ours, cycles = luminance(our_file), luminance(picture_file)
    print(f"{'region':8} {'':6} {'pixels':>6} {'ours':>6} {'Cycles':>6} {'ratio':>5}")
    for name, region in regions.items():
        for of, part in (("all", region), ("ground", region & ~of_body), ("bodies", region & of_body)):
            if not part.any():
                continue
            means = ours[part].mean(), cycles[part].mean()
            print(f"{name:8} {of:6} {part.sum():6} {means[0]:6.3f} {means[1]:6.3f} {means[0] / means[1]:5.2f}")


for old in list(bpy.data.objects):
    bpy.data.objects.remove(old)
add_bodies()
add_ground()
add_sun()
add_sky()
add_camera()
scene = bpy.context.scene
scene.render.engine = "CYCLES"
scene.cycles.samples = int(samples)
scene.cycles.use_denoising = False
scene.view_settings.view_transform = "Standard"
scene.render.resolution_x, scene.render.resolution_y = width, height
scene.render.resolution_percentage = 100
scene.render.filepath = picture_file
size_of_bodies = body_size()
write_passes(os.path.dirname(picture_file), CONTACT_REACH * size_of_bodies)
bpy.ops.render.render(write_still=True)
print_regions(os.path.dirname(picture_file), size_of_bodies)
