// WebXR: a headset stands in the crowd, where the view's eye stood; its floor is the scene's floor.

/** Shows a button if a headset is there; `eye` says where to stand, `tick` draws each frame. */
async function offerHeadset(button, solidNow, eyeNow, tick) {
  const found = await navigator.xr?.isSessionSupported("immersive-vr").catch(() => false);
  button.hidden = !found;
  if (!found) return;
  button.onclick = () => enterHeadset(button, solidNow(), eyeNow(), tick).catch(({ message }) => {
    button.title = message;
  });
}

async function enterHeadset(button, solid, eye, tick) {
  const { renderer, camera } = solid;
  if (renderer.xr.isPresenting) {
    await renderer.xr.getSession().end();
    return;
  }
  const session = await navigator.xr.requestSession("immersive-vr", { optionalFeatures: ["local-floor", "bounded-floor"] });
  renderer.xr.enabled = true;
  renderer.xr.setReferenceSpaceType("local-floor");
  await renderer.xr.setSession(session);
  solid.rig.position.set(eye.x, eye.y, 0);
  solid.rig.rotation.set(0, 0, eye.yaw - Math.PI / 2);
  camera.position.y = 0; // the headset brings its height
  camera.rotation.x = 0;
  button.setAttribute("aria-pressed", "true");
  renderer.setAnimationLoop(tick);
  session.addEventListener("end", () => {
    renderer.setAnimationLoop(null);
    renderer.xr.enabled = false;
    button.setAttribute("aria-pressed", "false");
    tick(performance.now());
  });
}
