// What the pages use of three.js; the bundle holds nothing else.
export {
  AmbientLight, BoxGeometry, BufferAttribute, BufferGeometry, CanvasTexture, Color, ColorManagement, CylinderGeometry, DirectionalLight,
  DoubleSide, DynamicDrawUsage, Fog, Group, HemisphereLight, InstancedMesh, Line, LineBasicMaterial, LineSegments,
  Matrix4, Mesh, MeshBasicMaterial, MeshLambertMaterial, PerspectiveCamera, PlaneGeometry, Points, PointsMaterial,
  Quaternion, Scene, Shape, ShapeGeometry, SphereGeometry, Sprite, SpriteMaterial, Vector3, WebGLRenderer,
} from "three";
export { ConvexGeometry } from "three/examples/jsm/geometries/ConvexGeometry.js";
