// Loads three.js, which the page carries packed, and only when the view in three dimensions is asked for.

const solidLibrary = { loading: null };

/** Resolves when THREE is there. */
function loadThree() {
  solidLibrary.loading ??= inflate(byId("three").textContent).then((bytes) => {
    const script = document.createElement("script");
    script.textContent = new TextDecoder().decode(bytes); // the page's policy knows its hash
    document.head.append(script);
    if (!globalThis.THREE) throw new Error("three.js cannot be loaded");
  });
  return solidLibrary.loading;
}

/** Returns true if the browser can draw in three dimensions. */
function hasWebGL() {
  try {
    const canvas = document.createElement("canvas");
    const context = canvas.getContext("webgl2");
    context?.getExtension("WEBGL_lose_context")?.loseContext();
    return Boolean(context);
  } catch {
    return false;
  }
}
