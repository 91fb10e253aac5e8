// What the 3-D panel of Foxglove Studio takes from a package that was never published (@foxglove/den).
// Written from how the panel uses it. Pictures of cameras are not decoded here.

/** Values by key, in the order of the keys; what a coordinate frame keeps its transforms in. */
export class ArrayMap {
  #rows = [];
  get size() {
    return this.#rows.length;
  }
  at(index) {
    return this.#rows[index];
  }
  clear() {
    this.#rows = [];
  }
  /** Index of a key; where it is missing, the complement (~) of where it would be. */
  binarySearch(key) {
    let low = 0;
    let high = this.#rows.length - 1;
    while (low <= high) {
      const middle = (low + high) >> 1;
      const there = this.#rows[middle][0];
      if (there === key) return middle;
      if (there < key) low = middle + 1;
      else high = middle - 1;
    }
    return ~low;
  }
  set(key, value) {
    const index = this.binarySearch(key);
    if (index >= 0) this.#rows[index][1] = value;
    else this.#rows.splice(~index, 0, [key, value]);
  }
  remove(key) {
    const index = this.binarySearch(key);
    return index >= 0 ? this.#rows.splice(index, 1)[0][1] : undefined;
  }
  removeBefore(key) {
    const index = this.binarySearch(key);
    this.#rows.splice(0, index >= 0 ? index : ~index);
  }
  removeAfter(key) {
    const index = this.binarySearch(key);
    this.#rows.length = index >= 0 ? index + 1 : ~index;
  }
  minEntry() {
    return this.#rows[0];
  }
  maxEntry() {
    return this.#rows[this.#rows.length - 1];
  }
  minKey() {
    return this.minEntry()?.[0];
  }
  maxKey() {
    return this.maxEntry()?.[0];
  }
}

/** Several values for each key. */
export class MultiMap extends Map {
  set(key, value) {
    return super.set(key, [...(this.get(key) ?? []), value]);
  }
}

/** The results that are true, of a function over a list. */
export const filterMap = (list, f) => Array.from(list, f).filter(Boolean);

const none = () => {
  throw new Error("images are not decoded here");
};
export class PinholeCameraModel {}
export const [decodeYUV, decodeRGB8, decodeRGBA8, decodeBGRA8, decodeBGR8] = Array(5).fill(none);
export const [decodeFloat1c, decodeBayerRGGB8, decodeBayerBGGR8] = Array(3).fill(none);
export const [decodeBayerGBRG8, decodeBayerGRBG8, decodeMono8] = Array(3).fill(none);
export const [decodeMono16, decodeYUYV] = Array(2).fill(none);

const child = (of, name) => [...(of?.children ?? [])].find((c) => c.tagName === name);
const numbers = (text, without) => (text ?? without).trim().split(/\s+/).map(Number);
const vector = (text, without = "0 0 0") => {
  const [x, y, z] = numbers(text, without);
  return { x, y, z };
};
const origin = (of) => ({
  xyz: vector(child(of, "origin")?.getAttribute("xyz")),
  rpy: vector(child(of, "origin")?.getAttribute("rpy")),
});

function geometry(of) {
  const shape = child(of, "geometry").children[0];
  const value = (name) => shape.getAttribute(name) ?? undefined;
  const geometryType = shape.tagName;
  if (geometryType === "box") return { geometryType, size: vector(value("size")) };
  if (geometryType === "mesh") {
    return { geometryType, filename: value("filename"), scale: vector(value("scale"), "1 1 1") };
  }
  return { geometryType, radius: Number(value("radius")), length: Number(value("length")) };
}

function material(of) {
  const rgba = child(of, "color")?.getAttribute("rgba");
  const [r, g, b, a] = numbers(rgba, "0 0 0 0");
  return { name: of.getAttribute("name"), color: rgba ? { r, g, b, a } : undefined };
}

function visual(of) {
  const its = child(of, "material");
  return { origin: origin(of), geometry: geometry(of), material: its && material(its) };
}

/** A robot of URDF: links with what is seen of them, and joints. */
export async function parseRobot(text) {
  const root = new DOMParser().parseFromString(text, "text/xml").documentElement;
  const every = (name) => [...root.children].filter((c) => c.tagName === name);
  const named = (name, f) => new Map(every(name).map((c) => [c.getAttribute("name"), f(c)]));
  const part = (of, name) => [...of.children].filter((c) => c.tagName === name).map(visual);
  return {
    name: root.getAttribute("name"),
    materials: named("material", material),
    links: named("link", (c) => ({
      name: c.getAttribute("name"),
      visuals: part(c, "visual"),
      colliders: part(c, "collision"),
    })),
    joints: named("joint", (c) => ({
      name: c.getAttribute("name"),
      jointType: c.getAttribute("type"),
      origin: origin(c),
      parent: child(c, "parent").getAttribute("link"),
      child: child(c, "child").getAttribute("link"),
      axis: vector(child(c, "axis")?.getAttribute("xyz"), "1 0 0"),
    })),
  };
}
