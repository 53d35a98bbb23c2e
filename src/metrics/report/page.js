"use strict";
// The pictures are half floats, their high bytes above their low ones in a PNG, so that they can be exposed here.
(() => {
  const settings = JSON.parse(document.getElementById("settings").textContent);
  const { width, height } = settings;
  const views = [...document.querySelectorAll(".view")];
  const main = document.getElementById("pictures");
  const exposure = document.getElementById("exposure");
  const divider = document.getElementById("divider");
  const clamp = (value, lower, upper) => Math.min(Math.max(value, lower), upper);

  // What all views show: how much larger than fitting, and which place (0 to 1 across and down) is in the middle.
  const state = { zoom: 1, x: 0.5, y: 0.5 };
  const kMaxZoom = 200;

  function decodeHalf(bits) {
    const sign = bits & 0x8000 ? -1 : 1, exponent = (bits >> 10) & 0x1f, fraction = bits & 0x3ff;
    if (exponent === 31) return fraction ? NaN : sign * Infinity;
    return sign * (exponent ? (1 + fraction / 1024) * 2 ** (exponent - 15) : fraction * 2 ** -24);
  }

  function encodeSrgb(linear) {
    if (!(linear > 0)) return 0;
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * Math.min(linear, 1) ** (1 / 2.4) - 0.055;
  }

  class Picture {
    constructor(name, exponent) {
      const source = document.getElementById(name + "-bytes");
      this.canvas = document.getElementById(name + "-canvas");
      this.scale = 2 ** exponent;
      this.canvas.width = width;
      this.canvas.height = 2 * height;
      const context = this.canvas.getContext("2d", { willReadFrequently: true });
      context.drawImage(source, 0, 0);
      const bytes = context.getImageData(0, 0, width, 2 * height).data;
      this.canvas.height = height;
      this.halves = new Uint16Array(width * height * 4);
      const low = width * height * 4;
      for (let i = 0; i < low; ++i) this.halves[i] = (bytes[i] << 8) | bytes[low + i];
      this.shown = new ImageData(width, height);
    }

    // There are only 65 536 half floats: one table has what each looks like.
    expose(ev) {
      const table = new Uint8Array(65536);
      for (let bits = 0; bits < 65536; ++bits) table[bits] = Math.round(255 * encodeSrgb(decodeHalf(bits) * this.scale * 2 ** ev));
      const data = this.shown.data;
      for (let i = 0; i < data.length; i += 4) {
        for (let c = 0; c < 3; ++c) data[i + c] = table[this.halves[i + c]];
        data[i + 3] = 255;
      }
      this.canvas.getContext("2d").putImageData(this.shown, 0, 0);
    }

    read(x, y) {
      const i = (y * width + x) * 4;
      return [0, 1, 2].map((c) => (decodeHalf(this.halves[i + c]) * this.scale).toPrecision(4)).join("  ");
    }
  }

  /** Pixels of the screen per pixel of the picture, and where the picture's corner is. */
  function place(view) {
    const scale = Math.min(view.clientWidth / width, view.clientHeight / height) * state.zoom;
    return { scale, left: view.clientWidth / 2 - state.x * width * scale, top: view.clientHeight / 2 - state.y * height * scale };
  }

  function showPlaces() {
    for (const view of views) {
      const { scale, left, top } = place(view);
      for (const picture of view.querySelectorAll(".picture"))
        picture.style.transform = `translate(${left}px, ${top}px) scale(${scale})`;
    }
    document.getElementById("zoom-value").textContent = `${place(main).scale.toPrecision(3)}×`;
  }

  function moveTo(x, y) {
    state.x = clamp(x, 0, 1);
    state.y = clamp(y, 0, 1);
    showPlaces();
  }

  /** @param at  the place of the view that stays where it is; its middle, if it is not given */
  function zoomBy(factor, view = main, at = { x: view.clientWidth / 2, y: view.clientHeight / 2 }) {
    const before = place(view);
    state.zoom = clamp(state.zoom * factor, 1, kMaxZoom);
    const { scale } = place(view);
    const u = (at.x - before.left) / before.scale, v = (at.y - before.top) / before.scale;
    moveTo((u + (view.clientWidth / 2 - at.x) / scale) / width, (v + (view.clientHeight / 2 - at.y) / scale) / height);
  }

  function fit() {
    state.zoom = 1;
    moveTo(0.5, 0.5);
  }

  function showDivider() {
    const percent = Number(divider.value);
    document.getElementById("image-layer").style.clipPath = `inset(0 ${100 - percent}% 0 0)`;
    document.getElementById("handle").style.left = `${percent}%`;
  }

  function moveDivider(percent) {
    divider.value = clamp(percent, 0, 100);
    showDivider();
  }

  function placeInView(view, event) {
    const box = view.getBoundingClientRect();
    return { x: event.clientX - box.left, y: event.clientY - box.top };
  }

  function onKey(event) {
    const step = 40, { scale } = place(event.currentTarget);
    const dx = step / (width * scale), dy = step / (height * scale);
    const actions = {
      ArrowLeft: () => moveTo(state.x - dx, state.y),
      ArrowRight: () => moveTo(state.x + dx, state.y),
      ArrowUp: () => moveTo(state.x, state.y - dy),
      ArrowDown: () => moveTo(state.x, state.y + dy),
      "+": () => zoomBy(1.25, event.currentTarget),
      "=": () => zoomBy(1.25, event.currentTarget),
      "-": () => zoomBy(0.8, event.currentTarget),
      0: fit,
      "[": () => moveDivider(Number(divider.value) - 2),
      "]": () => moveDivider(Number(divider.value) + 2),
    };
    if (event.ctrlKey || event.metaKey || event.altKey || !(event.key in actions)) return;
    actions[event.key]();
    event.preventDefault();
  }

  function watchView(view) {
    let last = null;  // where the pointer was that drags
    view.addEventListener("keydown", onKey);
    view.addEventListener("wheel", (event) => {
      zoomBy(Math.exp(-0.002 * event.deltaY), view, placeInView(view, event));
      event.preventDefault();
    }, { passive: false });
    view.addEventListener("pointerdown", (event) => {
      if (event.button !== 0 || event.target.id === "handle") return;
      view.setPointerCapture(event.pointerId);
      last = placeInView(view, event);
    });
    view.addEventListener("pointermove", (event) => {
      if (last && view.hasPointerCapture(event.pointerId)) {
        const at = placeInView(view, event), { scale } = place(view);
        moveTo(state.x - (at.x - last.x) / (width * scale), state.y - (at.y - last.y) / (height * scale));
        last = at;
      }
      showPixel(view, event);
    });
  }

  function watchHandle() {
    const handle = document.getElementById("handle");
    handle.addEventListener("pointerdown", (event) => handle.setPointerCapture(event.pointerId));
    handle.addEventListener("pointermove", (event) => {
      if (handle.hasPointerCapture(event.pointerId)) moveDivider((100 * placeInView(main, event).x) / main.clientWidth);
    });
  }

  let pictures = [];

  function showPixel(view, event) {
    const at = placeInView(view, event), { scale, left, top } = place(view);
    const x = Math.floor((at.x - left) / scale), y = Math.floor((at.y - top) / scale);
    if (pictures.length === 0 || x < 0 || y < 0 || x >= width || y >= height) return;
    const [image, reference] = pictures.map((picture) => picture.read(x, y));
    document.getElementById("pixel").textContent = `pixel ${x}, ${y}: image ${image}; reference ${reference}`;
  }

  function expose() {
    const ev = Number(exposure.value);
    document.getElementById("exposure-value").textContent = `${ev > 0 ? "+" : ""}${ev} EV`;
    for (const picture of pictures) picture.expose(ev);
  }

  async function start() {
    exposure.min = settings.exposure - 12;
    exposure.max = settings.exposure + 12;
    exposure.value = settings.exposure;
    views.forEach(watchView);
    watchHandle();
    exposure.addEventListener("input", expose);
    divider.addEventListener("input", showDivider);
    document.getElementById("zoom-in").addEventListener("click", () => zoomBy(1.25));
    document.getElementById("zoom-out").addEventListener("click", () => zoomBy(0.8));
    document.getElementById("fit").addEventListener("click", fit);
    new ResizeObserver(showPlaces).observe(document.body);
    await Promise.all(["image-bytes", "reference-bytes"].map((id) => document.getElementById(id).decode()));
    pictures = [new Picture("image", settings.imageExponent), new Picture("reference", settings.referenceExponent)];
    expose();
    showDivider();
    showPlaces();
  }

  start();
})();
