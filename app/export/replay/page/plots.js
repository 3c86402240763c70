// Numbers over time, with a cursor at the time that is shown.

const lineColours = ["#22272c", "#0072b2", "#d55e00", "#009e73", "#cc79a7"];
const margin = { left: 8, right: 8, top: 34, bottom: 6 };

// Four digits, as short as they go.
function numberText(value) {
  if (value === 0) return "0";
  const size = Math.abs(value);
  return size >= 1e5 || size < 1e-3 ? value.toExponential(2) : String(Number(value.toPrecision(4)));
}

class Plot {
  // `seek(frame)` is called where the plot is pressed or dragged.
  constructor(parent, recording, { title, unit, lines }, seek) {
    this.title = unit ? `${title}, ${unit}` : title;
    this.lines = lines.map(({ name, stream }) => ({ name, values: recording.stream(stream) }));
    this.frameCount = recording.frameCount;
    const all = this.lines.flatMap(({ values }) => [values.reduce((a, b) => Math.min(a, b)),
      values.reduce((a, b) => Math.max(a, b))]);
    this.low = Math.min(0, ...all);
    this.high = Math.max(0, ...all);
    if (this.low === this.high) this.high = 1;
    this.canvas = document.createElement("canvas");
    this.canvas.setAttribute("role", "img");
    this.canvas.setAttribute("aria-label", this.title);
    parent.append(this.canvas);
    const pressed = (event) => {
      if (event.buttons === 0) return;
      const x = (event.offsetX - margin.left) / (this.canvas.clientWidth - margin.left - margin.right);
      seek(Math.round(x * (this.frameCount - 1)));
    };
    this.canvas.addEventListener("pointerdown", pressed);
    this.canvas.addEventListener("pointermove", pressed);
  }

  draw(frame) {
    const pixels = window.devicePixelRatio;
    const width = this.canvas.clientWidth, height = this.canvas.clientHeight;
    if (width === 0 || height === 0) return;
    fitPixels(this.canvas);
    const pen = this.canvas.getContext("2d");
    pen.setTransform(pixels, 0, 0, pixels, 0, 0);
    pen.clearRect(0, 0, width, height);
    const x = (at) => margin.left + (width - margin.left - margin.right) * at / Math.max(1, this.frameCount - 1);
    const y = (value) => margin.top +
      (height - margin.top - margin.bottom) * (this.high - value) / (this.high - this.low);
    this.drawRule(pen, [x(0), y(0)], [x(this.frameCount - 1), y(0)], "#b8bec3");
    this.lines.forEach(({ values }, i) => {
      pen.beginPath();
      values.forEach((value, at) => pen.lineTo(x(at), y(value)));
      pen.strokeStyle = lineColours[i % lineColours.length];
      pen.lineWidth = 1.3;
      pen.stroke();
    });
    this.drawRule(pen, [x(frame), margin.top - 4], [x(frame), height - margin.bottom], "#c02020");
    this.drawText(pen, frame, width);
  }

  drawRule(pen, from, to, colour) {
    pen.beginPath();
    pen.moveTo(...from);
    pen.lineTo(...to);
    pen.strokeStyle = colour;
    pen.lineWidth = 1;
    pen.stroke();
  }

  // The title with the range, and below it each line's name, or the value at the cursor of the only or first one.
  drawText(pen, frame, width) {
    const named = this.lines.length > 1;
    const words = this.lines.map(({ name, values }, i) =>
      ({ text: named ? name : numberText(values[frame]), colour: lineColours[i % lineColours.length] }));
    if (named) words[0].text += ` ${numberText(this.lines[0].values[frame])}`;
    const room = width - margin.left - margin.right;
    pen.font = "11px system-ui, sans-serif";
    pen.fillStyle = "#22272c";
    pen.fillText(`${this.title}   ${numberText(this.low)} to ${numberText(this.high)}`, margin.left, 13, room);
    const gap = 8;
    const needed = words.reduce((sum, { text }) => sum + pen.measureText(text).width + gap, -gap);
    pen.font = `${11 * Math.min(1, room / needed)}px system-ui, sans-serif`;
    let at = margin.left;
    for (const { text, colour } of words) {
      pen.fillStyle = colour;
      pen.fillText(text, at, 27);
      at += pen.measureText(text).width + gap * Math.min(1, room / needed);
    }
  }
}
