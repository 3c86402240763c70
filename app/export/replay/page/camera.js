// Vectors, matrices by columns as GL has them, and the camera. As render/frame/camera.cpp and render/passes/view.cpp.

const add = (a, b) => a.map((x, i) => x + b[i]);
const subtract = (a, b) => a.map((x, i) => x - b[i]);
const scale = (a, factor) => a.map((x) => x * factor);
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const norm = (a) => Math.hypot(...a);
const normalize = (a) => scale(a, 1 / norm(a));

function multiply(a, b) {
  const product = new Float32Array(16);
  for (let column = 0; column < 4; ++column) {
    for (let row = 0; row < 4; ++row) {
      for (let k = 0; k < 4; ++k) product[4 * column + row] += a[4 * k + row] * b[4 * column + k];
    }
  }
  return product;
}

// Rows: three axes; then the offset of each.
function affine(axes, offsets) {
  return new Float32Array([
    axes[0][0], axes[1][0], axes[2][0], 0, axes[0][1], axes[1][1], axes[2][1], 0,
    axes[0][2], axes[1][2], axes[2][2], 0, ...offsets, 1]);
}

function corners(box) {
  return [0, 1, 2, 3, 4, 5, 6, 7].map((i) => [0, 1, 2].map((axis) => (i >> axis & 1 ? box.max : box.min)[axis]));
}

function boxAround(positions) {
  const box = { min: [Infinity, Infinity, Infinity], max: [-Infinity, -Infinity, -Infinity] };
  for (let i = 0; i < positions.length; ++i) {
    const axis = i % 3;
    if (positions[i] < box.min[axis]) box.min[axis] = positions[i];
    if (positions[i] > box.max[axis]) box.max[axis] = positions[i];
  }
  return box;
}

// Where the recording has it, until somebody takes hold of it.
class Camera {
  constructor(recording) {
    this.recording = recording;
    this.scenery = recording.header.scenery;
    this.reset();
  }

  reset() {
    this.held = false;
    this.follow(0);
  }

  follow(frame) {
    if (this.held) return;
    const { eye, target } = this.recording.cameraAt(frame);
    this.target = [...target];
    const away = subtract(eye, target);
    this.distance = norm(away);
    this.azimuth = Math.atan2(away[1], away[0]);
    this.elevation = Math.asin(away[2] / this.distance);
  }

  backward() {
    const level = Math.cos(this.elevation);
    return [level * Math.cos(this.azimuth), level * Math.sin(this.azimuth), Math.sin(this.elevation)];
  }

  // Right, up, backward.
  axes() {
    const z = this.backward();
    const x = normalize(cross(Math.abs(z[2]) > 0.9999995 ? [0, 1, 0] : [0, 0, 1], z));
    return [x, cross(z, x), z];
  }

  // By radians.
  orbit(right, up) {
    this.held = true;
    this.azimuth -= right;
    this.elevation = Math.min(1.55, Math.max(-1.55, this.elevation + up));
  }

  zoom(factor) {
    this.held = true;
    const nearest = 0.02, farthest = 50;  // of the scene's own distance
    const usual = norm(subtract(this.scenery.eye, this.scenery.target));
    this.distance = Math.min(farthest * usual, Math.max(nearest * usual, this.distance * factor));
  }

  // By fractions of the picture's height.
  shift(right, up, aspect) {
    this.held = true;
    const height = 2 * this.distance * this.slope(aspect);
    const [x, y] = this.axes();
    this.target = add(this.target, add(scale(x, -right * height), scale(y, -up * height)));
  }

  // A picture narrower than the scene's own shows the same from left to right: so many times more upwards.
  widening(aspect) {
    return Math.max(1, this.scenery.aspect / aspect);
  }

  slope(aspect) {
    return Math.tan(this.scenery.field_of_view * Math.PI / 360) * this.widening(aspect);
  }

  // `casters`: the box around all meshes.
  view(width, height, casters) {
    const axes = this.axes();
    const eye = add(this.target, scale(axes[2], this.distance));
    const boxCorners = corners(casters);
    const depths = boxCorners.map((corner) => dot(axes[2], subtract(eye, corner)));
    const farCorner = Math.max(...boxCorners.map((corner) => norm(subtract(corner, this.target))));
    const groundRadius = Math.max(2.5 * this.distance, 2 * farCorner);
    const far = 1.01 * Math.max(...depths, this.distance + (this.scenery.grid_spacing ? groundRadius : 0));
    const nearest = Math.min(...depths);
    const near = Math.max(Math.min(0.02 * this.distance, 0.9 * nearest), 1e-4 * far);
    const slope = this.slope(width / height);
    const projection = new Float32Array(16);
    projection[0] = height / (slope * width);
    projection[5] = 1 / slope;
    projection[10] = -(far + near) / (far - near);
    projection[11] = -1;
    projection[14] = -2 * far * near / (far - near);
    const view = affine(axes, axes.map((axis) => -dot(axis, eye)));
    return { view, projection, viewProjection: multiply(projection, view), eye, target: this.target, near,
      nearest: Math.max(nearest, near), groundRadius, casters, width, height,
      pixelScale: height / (480 * this.widening(width / height)) };
  }
}
