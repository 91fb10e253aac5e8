// People in three dimensions as figures that a scenario brings; those far away keep the plain body.

const FIGURES_NEAR = 30; // m from the eye

/** Returns for each figure one mesh for each phase of a walk, for this number of people. */
function makeFigures(figures, count, group) {
  const material = new THREE.MeshLambertMaterial({ vertexColors: true, side: THREE.DoubleSide });
  return (figures ?? []).map((figure) => figure.phases.map((points) => {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(Float32Array.from(points, (v) => v / 1000), 3));
    geometry.setAttribute("color", new THREE.BufferAttribute(figureColours(figure.colours), 3));
    geometry.setIndex(figure.triangles);
    geometry.computeVertexNormals();
    const mesh = new THREE.InstancedMesh(geometry, material, count);
    mesh.instanceMatrix.setUsage(THREE.DynamicDrawUsage);
    mesh.frustumCulled = false;
    mesh.count = 0;
    group.add(mesh);
    return mesh;
  }));
}

function figureColours(text) {
  const bytes = new Float32Array(text.length / 2);
  for (let i = 0; i < bytes.length; i++) bytes[i] = parseInt(text.slice(2 * i, 2 * i + 2), 16) / 255;
  return bytes;
}

/** True if a person is drawn as a figure: near to the eye, on its own legs. */
const hasFigure = (crowd, p, away) => crowd.figures.length > 0 && !crowd.look(p) && away < FIGURES_NEAR;

/** Places a person's figure, in the phase of its walk. */
function placeFigure(crowd, p, x, y, heading) {
  const phases = crowd.figures[p % crowd.figures.length];
  const h = crowd.height(p);
  const mesh = phases[Math.floor((crowd.walked[p] / (BODY.stride * h)) * phases.length) % phases.length];
  const s = scratch;
  s.m ??= new THREE.Matrix4();
  s.m.makeRotationZ(heading).scale(new THREE.Vector3(h, h, h)).setPosition(x, y, 0);
  mesh.setMatrixAt(mesh.count, s.m);
  mesh.count += 1;
}
