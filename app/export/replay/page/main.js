// The player: what is shown, and what moves it.
// An address may end in #frame=120&show=particles,contacts,wireframe&plots=0, to point at a moment;
// bare=640x480 leaves the picture alone, in that size.

const element = (id) => document.getElementById(id);
const speeds = [0.1, 0.25, 0.5, 1, 2, 4];

class Player {
  constructor(recording) {
    this.recording = recording;
    this.camera = new Camera(recording);
    this.picture = new Picture(element("picture"), recording);
    this.frame = 0;
    this.speed = 1;
    this.playing = false;
    this.plots = recording.header.plots.map((plot) =>
      new Plot(element("plots"), recording, plot, (frame) => this.seek(frame)));
    element("frame").max = recording.frameCount - 1;
    this.listen();
    new ResizeObserver(() => this.redraw()).observe(element("picture"));
    this.readAddress();
  }

  listen() {
    element("play").addEventListener("click", () => this.play(!this.playing));
    element("frame").addEventListener("input", (event) => this.seek(event.target.valueAsNumber));
    for (const id of ["particles", "contacts", "wireframe", "graphs"]) {
      element(id).addEventListener("change", () => this.redraw());
    }
    element("reset").addEventListener("click", () => this.resetCamera());
    element("help").addEventListener("click", () => element("about").showModal());
    window.addEventListener("hashchange", () => this.readAddress());
    window.addEventListener("keydown", (event) => this.pressKey(event));
    element("picture").addEventListener("webglcontextlost", () => showError("The picture was lost; reload the page."));
    new Gestures(element("picture"), this.camera, () => this.redraw());
    element("picture").addEventListener("dblclick", () => this.resetCamera());
  }

  readAddress() {
    const wishes = new URLSearchParams(location.hash.slice(1));
    const shown = (wishes.get("show") ?? "").split(",");
    for (const id of ["particles", "contacts", "wireframe"]) element(id).checked = shown.includes(id);
    element("graphs").checked = wishes.get("plots") !== "0";
    const size = /^(\d+)x(\d+)$/.exec(wishes.get("bare") ?? "");
    document.body.classList.toggle("bare", size !== null);
    document.querySelector("main").style.cssText = size ? `flex: none; width: ${size[1]}px; height: ${size[2]}px` : "";
    const first = this.recording.header.first_frame;
    if (wishes.has("frame")) this.seek(Number(wishes.get("frame")) - first);
    else this.play(!window.matchMedia("(prefers-reduced-motion: reduce)").matches);
  }

  play(playing) {
    this.playing = playing;
    element("play").textContent = playing ? "Pause" : "Play";
    this.since = undefined;
    if (playing && this.frame === this.recording.frameCount - 1) this.frame = 0;
    this.redraw();
  }

  // To a frame, and stays there.
  seek(frame) {
    const last = this.recording.frameCount - 1;
    this.frame = Math.min(last, Math.max(0, Number.isFinite(frame) ? Math.round(frame) : 0));
    this.play(false);
  }

  resetCamera() {
    this.camera.reset();
    this.redraw();
  }

  pressKey(event) {
    if (event.ctrlKey || event.metaKey || event.altKey || element("about").open) return;
    const stride = event.shiftKey ? 10 : 1;
    const toggle = (id) => () => {
      element(id).checked = !element(id).checked;
      this.redraw();
    };
    const actions = {
      " ": () => this.play(!this.playing),
      ArrowLeft: () => this.seek(this.frame - stride),
      ArrowRight: () => this.seek(this.frame + stride),
      Home: () => this.seek(0),
      End: () => this.seek(this.recording.frameCount - 1),
      "+": () => this.changeSpeed(1),
      "-": () => this.changeSpeed(-1),
      p: toggle("particles"), c: toggle("contacts"), w: toggle("wireframe"), g: toggle("graphs"),
      r: () => this.resetCamera(),
      h: () => element("about").showModal(),
    };
    const action = actions[event.key];
    if (!action || (event.key === " " && ["BUTTON", "INPUT"].includes(event.target.tagName) &&
      event.target.id !== "frame")) return;
    event.preventDefault();
    action();
  }

  changeSpeed(by) {
    const at = speeds.indexOf(this.speed) + by;
    this.speed = speeds[Math.min(speeds.length - 1, Math.max(0, at))];
    this.since = undefined;
    this.redraw();
  }

  redraw() {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame((now) => {
      this.waiting = false;
      try {
        this.advance(now);
        this.draw();
      } catch (error) {
        showError(error.message);
        throw error;
      }
      if (this.playing) this.redraw();
    });
  }

  // `now`: ms.
  advance(now) {
    if (!this.playing) return;
    const { frameCount, header } = this.recording;
    if (this.since === undefined) this.since = { now, frame: this.frame };
    const passed = (now - this.since.now) / 1000 * header.frames_per_second * this.speed;
    this.frame = Math.min(frameCount - 1, Math.floor(this.since.frame + passed));
    if (this.frame === frameCount - 1) this.play(false);
  }

  draw() {
    const { recording, frame } = this;
    fitPixels(element("picture"));
    const show = Object.fromEntries(["particles", "contacts", "wireframe"].map((id) => [id, element(id).checked]));
    this.camera.follow(frame);
    this.picture.draw(frame, this.camera, show);
    element("plots").hidden = !element("graphs").checked;
    for (const plot of this.plots) plot.draw(frame);
    element("frame").value = frame;
    const time = `t = ${recording.time(frame).toFixed(2)} s`;
    element("frame").setAttribute("aria-valuetext", time);
    element("caption").textContent = `${recording.header.title}\n${time}   step ${recording.step(frame)}`;
    element("time").textContent = `frame ${recording.frameNumber(frame)}` +
      (this.speed === 1 ? "" : `   x${this.speed}`);
  }
}

// One pointer orbits, or shifts while shift or the right button is held; two zoom and shift.
class Gestures {
  constructor(canvas, camera, moved) {
    this.canvas = canvas;
    this.camera = camera;
    this.moved = moved;
    this.pointers = new Map();
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      this.pointers.set(event.pointerId, [event.clientX, event.clientY]);
    });
    canvas.addEventListener("pointermove", (event) => this.move(event));
    for (const end of ["pointerup", "pointercancel"]) {
      canvas.addEventListener(end, (event) => this.pointers.delete(event.pointerId));
    }
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      const lines = event.deltaMode === WheelEvent.DOM_DELTA_LINE;
      camera.zoom(Math.exp((lines ? 20 : 1) * event.deltaY * 0.001));
      moved();
    }, { passive: false });
  }

  move(event) {
    const before = this.pointers.get(event.pointerId);
    if (!before) return;
    const height = this.canvas.clientHeight;
    const right = (event.clientX - before[0]) / height, up = -(event.clientY - before[1]) / height;
    const aspect = this.canvas.clientWidth / height;
    const spread = this.spread();
    this.pointers.set(event.pointerId, [event.clientX, event.clientY]);
    if (this.pointers.size === 2) {
      this.camera.zoom(spread / this.spread());
      this.camera.shift(0.5 * right, 0.5 * up, aspect);
    } else if (event.shiftKey || event.buttons === 2) {
      this.camera.shift(right, up, aspect);
    } else if (this.pointers.size === 1) {
      this.camera.orbit(3 * right, -3 * up);
    }
    this.moved();
  }

  // Pixels between two pointers.
  spread() {
    const [a, b] = [...this.pointers.values()];
    return b ? Math.max(1, Math.hypot(a[0] - b[0], a[1] - b[1])) : 1;
  }
}

// As many pixels as the screen has where the canvas is.
function fitPixels(canvas) {
  for (const [side, shown] of [["width", canvas.clientWidth], ["height", canvas.clientHeight]]) {
    const pixels = Math.max(1, Math.round(shown * window.devicePixelRatio));
    if (canvas[side] !== pixels) canvas[side] = pixels;
  }
}

function showError(text) {
  element("message").textContent = text;
  element("message").hidden = false;
}

function describeAccuracy({ lattice, program, frames_per_second: rate, frames }) {
  const share = lattice.extent > 0 ? lattice.max_error / lattice.extent : 0;
  return `${frames} frames, ${rate} a second, by ${program}. Positions are those of the simulation within ` +
    `${numberText(1000 * lattice.max_error)} mm, ${numberText(share)} of the extent of ` +
    `${numberText(lattice.extent)} m, along each axis; normals of contacts within 1/254.`;
}

async function start() {
  try {
    if (!window.DecompressionStream) throw new Error("This browser is too old: it has no DecompressionStream.");
    const header = JSON.parse(element("header").textContent);
    document.querySelector("#about h1").textContent = header.title;
    element("accuracy").textContent = describeAccuracy(header);
    const player = new Player(new Recording(header, await unpack(element("data").textContent)));
    player.redraw();
  } catch (error) {
    showError(error.message);
    throw error;
  }
}

start();
