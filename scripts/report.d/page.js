"use strict";
// Makes a page to be read of what scripts/report gathered: contents, tables that sort in place of printed ones, and
// diagrams that tell their values. Without it the same texts and pictures are there, unsorted.

const make = (name, attributes = {}, ...children) => {
  const isDrawing = ["svg", "g", "path", "rect", "line", "text", "circle"].includes(name);
  const node = isDrawing ? document.createElementNS("http://www.w3.org/2000/svg", name) : document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
  node.append(...children);
  return node;
};

// Contents

const writeContents = () => {
  const list = make("ul");
  document.querySelectorAll("h2").forEach((heading, i) => {
    heading.id ||= `part${i}`;
    list.append(make("li", {}, make("a", { href: `#${heading.id}` }, heading.textContent)));
  });
  document.getElementById("contents").append(list);
};

// Tables

// "1,234", "4.5x", "12 %", "1/60", "2e-15": what a column is sorted by.
const numberOf = (text) => {
  const found = text.replace(/(\d),(?=\d{3})/g, "$1").match(/^[^\d-]{0,2}(-?[\d.]+(?:e[+-]?\d+)?)(?:\/(\d+))?/i);
  if (!found) return NaN;
  return parseFloat(found[1]) / (found[2] ? parseFloat(found[2]) : 1);
};

const isRule = (line) => /^-+( {2,}-+)+$|^-{3,}$/.test(line);

// Where columns begin and end, from the rule below the headings.
const columnsOf = (rule) => [...rule.matchAll(/-+/g)].map((part) => [part.index, part.index + part[0].length]);

const cellsOf = (line, columns) => columns.map(([begin, end]) => line.slice(begin, end).trim());

// Lines of a printed table to headings and rows; a line that begins with blanks continues the row above it.
const readTable = (headLines, rule, lines) => {
  const columns = columnsOf(rule);
  const groups = new Map();
  const heads = columns.map(() => []);
  for (const line of headLines) {
    if (/--+ .+ --+/.test(line) || (headLines.length > 1 && line === headLines[0] && /^ {4,}/.test(line))) {
      for (const part of line.matchAll(/(?:-+ )?([^-\s].*?)(?: -+)?(?= {2,}|$)/g)) {
        columns.forEach(([begin, end], i) => {
          const from = part.index, to = part.index + part[0].length;
          if (end > from && begin < to) groups.set(i, part[1].trim());
        });
      }
      continue;
    }
    cellsOf(line, columns).forEach((cell, i) => cell && heads[i].push(cell));
  }
  const headings = heads.map((parts, i) => (groups.has(i) ? [groups.get(i), ...parts] : parts).join("\n"));
  const rows = [];
  for (const line of lines) {
    const cells = cellsOf(line, columns);
    if (cells[0] === "" && rows.length > 0) {
      cells.forEach((cell, i) => { if (cell) rows.at(-1)[i] += `\n${cell}`; });
    } else {
      rows.push(cells);
    }
  }
  return { headings, rows };
};

const sortBy = (table, column, button) => {
  const head = button.parentElement;
  const down = head.getAttribute("aria-sort") === "ascending";
  table.querySelectorAll("th").forEach((each) => each.removeAttribute("aria-sort"));
  head.setAttribute("aria-sort", down ? "descending" : "ascending");
  const body = table.tBodies[0];
  const keyed = [...body.rows].map((row) => {
    const text = row.cells[column].textContent;
    return { row, text, number: numberOf(text) };
  });
  keyed.sort((a, b) => {
    const [x, y] = down ? [b, a] : [a, b];
    if (Number.isNaN(x.number) && Number.isNaN(y.number)) return x.text.localeCompare(y.text);
    if (Number.isNaN(x.number)) return down ? -1 : 1;  // what is no number stays last
    if (Number.isNaN(y.number)) return down ? 1 : -1;
    return x.number - y.number;
  });
  body.append(...keyed.map(({ row }) => row));
};

const makeTable = ({ headings, rows }) => {
  const isWords = headings.map((_, i) => rows.filter((row) => Number.isNaN(numberOf(row[i]))).length > rows.length / 2);
  const head = make("tr");
  const body = make("tbody");
  const table = make("table", {}, make("thead", {}, head), body);
  headings.forEach((heading, i) => {
    const button = make("button", { type: "button", title: "Sort" }, heading || "#");
    button.addEventListener("click", () => sortBy(table, i, button));
    head.append(make("th", { class: isWords[i] ? "words" : "", scope: "col" }, button));
  });
  for (const row of rows) {
    body.append(make("tr", {}, ...row.map((cell, i) => make("td", { class: isWords[i] ? "words" : "" }, cell))));
  }
  return make("div", { class: "scroll" }, table);
};

// What a command printed, as paragraphs and tables before its raw text.
const showPrinted = (section) => {
  const lines = section.querySelector("pre").textContent.split("\n");
  const raw = section.querySelector("details");
  let text = [];
  const flush = () => {
    const paragraph = text.join("\n").trim();
    if (paragraph) raw.before(make("p", { class: "text" }, paragraph));
    text = [];
  };
  for (let i = 0; i < lines.length; ++i) {
    if (!isRule(lines[i])) { text.push(lines[i]); continue; }
    const head = [];
    while (text.length > 0 && text.at(-1).trim() !== "") head.unshift(text.pop());
    // A sentence right above the headings is none of them.
    const widths = columnsOf(lines[i]).at(-1)[1];
    while (head.length > 1 && head[0].length > widths) text.push(head.shift());
    const rule = lines[i];
    const rows = [];
    while (i + 1 < lines.length && lines[i + 1].trim() !== "" && !/^(- |Warning|")/.test(lines[i + 1])) rows.push(lines[++i]);
    flush();
    raw.before(makeTable(readTable(head, rule, rows)));
  }
  flush();
};

// Diagrams, from the scripts that gnuplot draws them by

const unquoted = (text) => text.replace(/''/g, "'");

const readDiagram = (script) => {
  const quotedAfter = (word) => {
    const found = script.match(new RegExp(`^set ${word} '((?:[^']|'')*)'`, "m"));
    return found ? unquoted(found[1]) : "";
  };
  const rangeOf = (axis) => {
    const found = script.match(new RegExp(`^set ${axis}range \\[(.*?):(.*?)\\]`, "m")) || [];
    return [found[1], found[2]].map((end) => (end === undefined || end === "*" ? null : parseFloat(end)));
  };
  const blocks = new Map();
  for (const [, name, data] of script.matchAll(/^\$(series\d+) << END\n([\s\S]*?)^END$/gm)) {
    blocks.set(name, data.split("\n").slice(0, -1).map((line) => (line ? line.split(" ").map(Number) : null)));
  }
  const series = [];
  const plot = script.slice(script.search(/^plot /m)).split("\nset ")[0];
  for (const found of plot.matchAll(/\$(series\d+) using 1:2 with (\w+) (.*?)(?:notitle|title '((?:[^']|'')*)' noenhanced)/g)) {
    series.push({ points: blocks.get(found[1]), lines: found[2].startsWith("lines"), marks: found[2] !== "lines",
      colour: (found[3].match(/rgb '(#\w+)'/) || [])[1] || "#000", dashed: /dt [23]/.test(found[3]),
      hollow: /pt (6|4|8|12|10|14) /.test(found[3]), name: unquoted(found[4] || "") });
  }
  const axis = (name) => ({ label: quotedAfter(`${name}label`), range: rangeOf(name),
    logarithmic: new RegExp(`^set logscale ${name}`, "m").test(script) });
  return { title: quotedAfter("title"), x: axis("x"), y: axis("y"), series };
};

const short = (value) => {
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size < 1e5 && size >= 1e-3) return String(+value.toPrecision(4));
  return value.toExponential(2).replace(/\.?0+e/, "e").replace("e+", "e");
};

// Where values of an axis are drawn, from `begin` to `end` pixels, and its ticks.
const makeScale = ({ range, logarithmic }, values, begin, end) => {
  const along = logarithmic ? Math.log10 : (value) => value;
  let low = along(range[0] ?? Math.min(...values)), high = along(range[1] ?? Math.max(...values));
  if (high === low) { low -= 0.5; high += 0.5; }
  if (range[0] === null) low -= 0.03 * (high - low);
  if (range[1] === null) high += 0.03 * (high - low);
  const at = (value) => begin + ((along(value) - low) / (high - low)) * (end - begin);
  const ticks = [];
  if (logarithmic && high - low >= 1) {
    const every = Math.ceil((high - low) / 8);
    for (let power = Math.ceil(low); power <= high; power += every) ticks.push(10 ** power);
  } else {
    const rough = (high - low) / 6, power = 10 ** Math.floor(Math.log10(rough));
    const step = [1, 2, 5, 10].find((factor) => factor * power >= rough) * power;
    for (let i = Math.ceil(low / step); i * step <= high; ++i) {
      ticks.push(logarithmic ? 10 ** (i * step) : +(i * step).toPrecision(12));
    }
  }
  return { at, ticks };
};

const finitePoints = (series) => series.points.filter((point) => point && point.every(Number.isFinite));

// The middles between neighbours: the sides of a map's cells.
const cellSides = (values, at) => {
  const places = [...new Set(values)].sort((a, b) => a - b);
  const middle = (i) => (at(places[i]) + at(places[i + 1])) / 2;
  return new Map(places.map((value, i) => {
    const left = i > 0 ? middle(i - 1) : places.length > 1 ? 2 * at(value) - middle(0) : at(value) - 8;
    const right = i + 1 < places.length ? middle(i) : places.length > 1 ? 2 * at(value) - middle(i - 1) : at(value) + 8;
    return [value, [Math.min(left, right), Math.max(left, right)]];
  }));
};

// Marks that fill a grid are a map: its cells are drawn in their colour.
const isMap = (series) => {
  const marked = series.filter((each) => each.marks && !each.lines).flatMap(finitePoints);
  if (marked.length < 12) return false;
  const columns = new Set(marked.map(([x]) => x)).size, rows = new Set(marked.map(([, y]) => y)).size;
  return columns > 2 && rows > 2 && marked.length > 0.6 * columns * rows;
};

const drawDiagram = (figure) => {
  const diagram = readDiagram(figure.querySelector("script").textContent);
  const all = diagram.series.flatMap(finitePoints);
  if (all.length === 0) return;
  const width = 760, height = 440, left = 70, right = 20, bottom = 52;
  const named = diagram.series.filter(({ name }) => name);
  const legendRows = Math.ceil(named.length / 2), top = 20 + 18 * legendRows;
  const svg = make("svg", { viewBox: `0 0 ${width} ${height + top}`, role: "img", "aria-label": diagram.title,
    "font-family": "system-ui, sans-serif", "font-size": 12, fill: "#1f2328" });
  const x = makeScale(diagram.x, all.map((point) => point[0]), left, width - right);
  const y = makeScale(diagram.y, all.map((point) => point[1]), height + top - bottom, top + 10);
  const text = (at, content, more = {}) => svg.append(make("text", { x: at[0], y: at[1], ...more }, content));
  for (const tick of x.ticks) {
    svg.append(make("line", { x1: x.at(tick), x2: x.at(tick), y1: top + 10, y2: height + top - bottom, stroke: "#e3e6e9" }));
    text([x.at(tick), height + top - bottom + 16], short(tick), { "text-anchor": "middle" });
  }
  for (const tick of y.ticks) {
    svg.append(make("line", { x1: left, x2: width - right, y1: y.at(tick), y2: y.at(tick), stroke: "#e3e6e9" }));
    text([left - 6, y.at(tick) + 4], short(tick), { "text-anchor": "end" });
  }
  text([(left + width - right) / 2, height + top - 12], diagram.x.label, { "text-anchor": "middle" });
  text([0, 0], diagram.y.label, { "text-anchor": "middle",
    transform: `translate(14 ${(height + 2 * top - bottom) / 2}) rotate(-90)` });
  named.forEach((series, i) => {
    const at = [left + (i % 2) * 330, 18 + 18 * Math.floor(i / 2)];
    svg.append(make("line", { x1: at[0], x2: at[0] + 22, y1: at[1] - 4, y2: at[1] - 4, stroke: series.colour,
      "stroke-width": series.marks && !series.lines ? 9 : 2.5, "stroke-dasharray": series.dashed ? "5 4" : "none" }));
    text([at[0] + 28, at[1]], series.name.length > 48 ? `${series.name.slice(0, 46)}...` : series.name);
  });
  const asMap = isMap(diagram.series);
  const marked = diagram.series.filter((each) => each.marks && !each.lines).flatMap(finitePoints);
  const columns = asMap && cellSides(marked.map((point) => point[0]), x.at);
  const rows = asMap && cellSides(marked.map((point) => point[1]), y.at);
  for (const series of diagram.series) {
    const points = finitePoints(series);
    if (series.lines) {
      let path = "", pen = "M";
      for (const point of series.points) {
        if (!point || !point.every(Number.isFinite)) { pen = "M"; continue; }
        path += `${pen}${x.at(point[0]).toFixed(1)} ${y.at(point[1]).toFixed(1)}`;
        pen = "L";
      }
      svg.append(make("path", { d: path, fill: "none", stroke: series.colour, "stroke-width": 2,
        "stroke-dasharray": series.dashed ? "6 4" : "none" }));
    }
    if (!series.marks) continue;
    for (const point of points) {
      if (asMap && !series.lines) {
        const within = ([low, high], least, most) => [Math.max(low, least), Math.min(high + 0.5, most)];
        const [from, to] = within(columns.get(point[0]), left, width - right);
        const [above, below] = within(rows.get(point[1]), top + 10, height + top - bottom);
        svg.append(make("rect", { x: from, width: to - from, y: above, height: below - above, fill: series.colour,
          "fill-opacity": series.hollow ? 0.35 : 0.75 }));
      } else {
        svg.append(make("circle", { cx: x.at(point[0]), cy: y.at(point[1]), r: 3.2, stroke: series.colour,
          fill: series.hollow ? "#fff" : series.colour }));
      }
    }
  }
  addPointer(figure, svg, diagram, x, y);
  figure.querySelector("img").replaceWith(svg);
};

// The value of the point nearest to the pointer, or to a finger.
const addPointer = (figure, svg, diagram, x, y) => {
  const places = diagram.series.flatMap((series) => finitePoints(series).map((point) => (
    { series, point, at: [x.at(point[0]), y.at(point[1])] })));
  const ring = make("circle", { r: 6, fill: "none", stroke: "#1f2328", "stroke-width": 1.5, visibility: "hidden" });
  svg.append(ring);
  const value = make("div", { class: "value", hidden: "" });
  figure.append(value);
  const show = (event) => {
    const box = svg.getBoundingClientRect(), scale = svg.viewBox.baseVal.width / box.width;
    const at = [(event.clientX - box.left) * scale, (event.clientY - box.top) * scale];
    const away = (place) => Math.hypot(place.at[0] - at[0], place.at[1] - at[1]);
    const nearest = places.reduce((best, place) => (away(place) < away(best) ? place : best));
    const isNear = away(nearest) < 40;
    value.hidden = !isNear;
    ring.setAttribute("visibility", isNear ? "visible" : "hidden");
    if (!isNear) return;
    ring.setAttribute("cx", nearest.at[0]);
    ring.setAttribute("cy", nearest.at[1]);
    const name = nearest.series.name ? `${nearest.series.name}\n` : "";
    value.textContent = `${name}${diagram.x.label}: ${short(nearest.point[0])}\n${diagram.y.label}: ${short(nearest.point[1])}`;
    value.style.left = `${Math.min(Math.max(nearest.at[0] / scale, 90), box.width - 90)}px`;
    value.style.top = `${svg.getBoundingClientRect().top - figure.getBoundingClientRect().top + nearest.at[1] / scale}px`;
  };
  svg.addEventListener("pointermove", show);
  svg.addEventListener("pointerdown", show);
  svg.addEventListener("pointerleave", () => { value.hidden = true; ring.setAttribute("visibility", "hidden"); });
};

writeContents();
document.querySelectorAll(".printed").forEach(showPrinted);
document.querySelectorAll("figure.diagram").forEach(drawDiagram);
