// Everything that is drawn: camera, films, borders, wires, balls, the box, and the way from light to screen colors.
import * as THREE from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { Balls } from "./balls";
import { mapTexture } from "./colormap";
import { Box, ColorTable, FieldPlace, Frame } from "./decode";
import { FILM_COLORS, findField, magnitudes, Range, showsPoints, thicknessField } from "./field";
import { FilmMesh } from "./films";
import { seenBalls } from "./hidden_balls";
import { reflectedUniforms } from "./interference";
import { Tubes } from "./lines";
import { Pace } from "./pace";
import { pickBall, pickRegion, Plane, Ray } from "./picking";
import { Axes, distanceToFit, usualAxes, Vector } from "./viewpoint";

export interface Look {
  coloring: string; // FILM_COLORS or a field's key
  range: Range | null; // of the colors
  thicknessNm: number; // of films that have no field of it
  opacity: number; // of films that show a field
  particles: boolean; // those that carry films are wanted
}

export type Pick = { kind: "region"; region: number } | { kind: "ball"; index: number } | null;

// Light is added up without limits; here, at the very end, it becomes a color that a screen has: the brightest lights
// are rolled off, and what lies outside the screen's gamut moves towards gray of the same luminance.
const SCREEN = /* glsl */ `
uniform sampler2D light;
varying vec2 vUv;
vec3 toScreen(vec3 c) {
  const vec3 weights = vec3(0.2126, 0.7152, 0.0722);
  float y = max(dot(c, weights), 0.0);
  float shoulder = y <= 0.7 ? y : 0.7 + 0.3 * (1.0 - exp(-(y - 0.7) / 0.6));
  c = y > 0.0 ? c * (shoulder / y) : vec3(0.0);
  float lowest = min(c.r, min(c.g, c.b));
  float highest = max(c.r, max(c.g, c.b));
  float keep = 1.0;
  if (lowest < 0.0) keep = min(keep, shoulder / (shoulder - lowest));
  if (highest > 1.0) keep = min(keep, (1.0 - shoulder) / (highest - shoulder));
  return clamp(vec3(shoulder) + keep * (c - vec3(shoulder)), 0.0, 1.0);
}
void main() {
  vec3 c = toScreen(texture2D(light, vUv).rgb);
  vec3 low = 12.92 * c;
  vec3 high = 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055;
  gl_FragColor = vec4(mix(high, low, vec3(lessThanEqual(c, vec3(0.0031308)))), 1.0);
}
`;

const BACKGROUND = /* glsl */ `
varying vec2 vUv;
void main() {
  float glow = 1.0 - smoothstep(0.0, 0.75, distance(vUv, vec2(0.5, 0.55)));
  gl_FragColor = vec4(mix(vec3(0.0035, 0.0042, 0.006), vec3(0.013, 0.016, 0.023), glow), 1.0);
}
`;

const FULL_SCREEN = /* glsl */ `
varying vec2 vUv;
void main() {
  vUv = 0.5 * position.xy + 0.5;
  gl_Position = vec4(position.xy, 0.9999, 1.0);
}
`;

function fullScreen(fragmentShader: string, uniforms: Record<string, THREE.IUniform> = {}): THREE.Mesh {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.Float32BufferAttribute([-1, -1, 0, 3, -1, 0, -1, 3, 0], 3));
  const mesh = new THREE.Mesh(geometry, new THREE.ShaderMaterial({ vertexShader: FULL_SCREEN, fragmentShader, uniforms, depthTest: false, depthWrite: false }));
  mesh.frustumCulled = false;
  return mesh;
}

const MARGIN = 1.06; // around what is fitted into the view
const NOTHING_CUT = [0, 0, 0, 1e30] as const;

export class Stage {
  private readonly renderer: THREE.WebGLRenderer;
  private readonly target: THREE.WebGLRenderTarget;
  private readonly plain: THREE.WebGLRenderTarget; // without multisampling: for slow pictures that move, and for balls
  private readonly light: THREE.IUniform;
  private readonly pace = new Pace();
  private readonly gl: WebGL2RenderingContext;
  private drawing: { fence: WebGLSync | null; began: number; sharpness: number } | null = null;
  private readonly scene = new THREE.Scene();
  private readonly screen = new THREE.Scene();
  private readonly camera = new THREE.PerspectiveCamera(32, 1, 0.01, 100);
  private readonly controls: OrbitControls;
  private readonly clip = new THREE.Vector4(...NOTHING_CUT);
  private cutAxis: { axis: 0 | 1 | 2; side: 1 | -1 } | null = null;
  private readonly films: FilmMesh;
  private readonly borders: Tubes;
  private readonly wires: Tubes;
  private readonly balls: Balls;
  private readonly solids: Balls;
  private readonly boxLines = new THREE.LineSegments(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({ color: 0x6c7a90, transparent: true, opacity: 0.35 }));
  private readonly bounds = new THREE.Box3();
  private readonly forward = new THREE.Vector3();
  private frame: Frame | null = null;
  private shown: { frame: Frame; coloring: string } | null = null;
  private radius: Float32Array = new Float32Array(0);
  private dirty = true;
  private fitted = false;

  /// @throws Error  this browser has no WebGL 2
  constructor(private readonly canvas: HTMLCanvasElement, table: ColorTable, onLost: () => void) {
    try {
      this.renderer = new THREE.WebGLRenderer({ canvas, antialias: false, powerPreference: "high-performance" });
    } catch {
      throw new Error("this browser has no WebGL 2, which the picture needs; charts and texts work");
    }
    this.gl = this.renderer.getContext() as WebGL2RenderingContext;
    this.renderer.outputColorSpace = THREE.LinearSRGBColorSpace; // the last pass encodes
    this.renderer.autoClear = false;
    this.target = new THREE.WebGLRenderTarget(1, 1, { type: THREE.HalfFloatType, samples: 4 });
    this.plain = new THREE.WebGLRenderTarget(1, 1, { type: THREE.HalfFloatType });
    this.light = { value: this.target.texture };
    canvas.addEventListener("webglcontextlost", onLost);

    const map = mapTexture();
    const reflected = reflectedUniforms(table);
    this.films = new FilmMesh(reflected, map, this.clip);
    this.borders = new Tubes(new THREE.Color(0.5, 0.56, 0.62), 0.35, this.clip);
    this.wires = new Tubes(new THREE.Color(0.72, 0.5, 0.28), 0.5, this.clip);
    this.balls = new Balls(new THREE.Color(0.35, 0.5, 0.6), reflected, map, this.clip);
    this.solids = new Balls(new THREE.Color(0.06, 0.06, 0.07), reflected, map, this.clip);
    const background = fullScreen(BACKGROUND);
    background.renderOrder = -1;
    this.scene.add(background, this.films.object, this.borders.object, this.wires.object, this.balls.object, this.solids.object, this.boxLines);
    this.screen.add(fullScreen(SCREEN, { light: this.light }));

    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = true;
    this.controls.dampingFactor = 0.12;
    this.controls.addEventListener("change", () => (this.dirty = true));
    new ResizeObserver(() => this.resize()).observe(canvas);
    const loop = (now: number): void => {
      requestAnimationFrame(loop);
      this.controls.update();
      if (this.isBusy(now)) return;
      const sharpness = this.pace.next(now, this.dirty);
      if (sharpness === null) return;
      this.draw(sharpness);
      this.drawing = { fence: this.gl.fenceSync(this.gl.SYNC_GPU_COMMANDS_COMPLETE, 0), began: now, sharpness };
    };
    requestAnimationFrame(loop);
  }

  /// Whether the last picture is not done yet: another one would only wait behind it, and what people do with it.
  private isBusy(now: number): boolean {
    if (!this.drawing) return false;
    const { fence, began, sharpness } = this.drawing;
    if (fence && this.gl.clientWaitSync(fence, 0, 0) === this.gl.TIMEOUT_EXPIRED) return true;
    this.gl.deleteSync(fence);
    this.drawing = null;
    this.pace.drawn(now - began, sharpness);
    return false;
  }

  private resize(): void {
    const width = Math.max(1, this.canvas.clientWidth);
    const height = Math.max(1, this.canvas.clientHeight);
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.renderer.setSize(width, height, false);
    const pixels = this.renderer.getDrawingBufferSize(new THREE.Vector2());
    this.target.setSize(pixels.x, pixels.y);
    this.camera.aspect = width / height;
    const { titles, legends } = this.taken();
    this.camera.setViewOffset(width, height, 0, 0.5 * (legends - titles), width, height); // to the middle of what is free
    if (this.frame && !this.touched) this.fit();
    this.dirty = true;
  }

  private get touched(): boolean {
    return this.fitted && this.camera.position.distanceToSquared(this.fittedAt) > 1e-12 * this.fittedAt.lengthSq();
  }
  private readonly fittedAt = new THREE.Vector3();

  private draw(sharpness: number): void {
    this.dirty = false;
    // The edges of balls are the shader's: multisampling would double what 100,000 of them cost and change nothing.
    const target = sharpness === 1 && this.films.object.visible ? this.target : this.plain;
    if (target === this.plain) target.setSize(Math.ceil(sharpness * this.target.width), Math.ceil(sharpness * this.target.height));
    this.light.value = target.texture;
    if (this.balls.object.visible) this.balls.choose(this.pace.isSlowHere ? this.seenBalls() : null);
    if (this.films.object.visible) this.films.sort(this.camera.getWorldDirection(this.forward));
    this.renderer.setRenderTarget(target);
    this.renderer.clear();
    this.renderer.render(this.scene, this.camera);
    this.renderer.setRenderTarget(null);
    this.renderer.render(this.screen, this.camera);
  }

  /// Flat foams hide nothing.
  private seenBalls(): Uint32Array | null {
    if (!this.frame?.points || this.frame.box?.dimension === 2) return null;
    this.camera.updateMatrixWorld();
    const axis = (k: number): Vector => new THREE.Vector3().setFromMatrixColumn(this.camera.matrixWorld, k).toArray();
    const height = this.target.height;
    const focus = (0.5 * height) / Math.tan((this.camera.fov * Math.PI) / 360);
    const shift = this.camera.view ? (this.camera.view.offsetY / this.camera.view.fullHeight) * height : 0;
    const eye = { position: this.camera.position.toArray(), right: axis(0), up: axis(1), back: axis(2), focus, width: this.target.width, height: height + 2 * Math.abs(shift) };
    return seenBalls(this.frame.points.position, this.radius, eye, this.clip.toArray());
  }

  show(frame: Frame, look: Look): void {
    const isNew = this.frame !== frame;
    this.frame = frame;
    const flat = frame.box?.dimension === 2;
    const field = look.coloring === FILM_COLORS ? undefined : findField(frame, look.coloring);
    if (this.shown?.frame !== frame || this.shown.coloring !== look.coloring) {
      this.setBounds(frame);
      const size = this.bounds.getSize(new THREE.Vector3()).length();
      /// What is colored at this place: the chosen field, or the thickness [nm].
      const values = (...places: FieldPlace[]): Float32Array | null => {
        if (field) return places.includes(field.place) ? magnitudes(field) : null;
        return thicknessField(frame, places.includes("points") ? "points" : "vertices")?.values.map((t) => 1e9 * t) ?? null;
      };
      this.films.show(frame.films, values("vertices", "triangles"), field?.place === "triangles");
      this.borders.show(frame.films?.borders ?? null, 0.0011 * size);
      this.wires.show(frame.films?.wires ?? null, 0.0024 * size);
      this.radius = this.radii(frame, size);
      this.balls.show(frame.points?.position ?? null, this.radius, values("points"), field ? look.range : null, flat);
      this.solids.show(frame.solids?.position ?? null, frame.solids?.radius ?? new Float32Array(0), null, null, false);
      this.showBox(frame.box);
      this.shown = { frame, coloring: look.coloring };
    }
    this.balls.object.visible = showsPoints(frame, look.coloring, look.particles);
    if (field && field.place !== "points") this.films.colorByField(look.range?.low ?? 0, look.range?.high ?? 1, look.opacity);
    else this.films.colorByFilm(thicknessField(frame, "vertices") !== undefined, look.thicknessNm);
    const range = this.balls.object.material.uniforms["range"];
    if (range && look.range) range.value = new THREE.Vector2(look.range.low, look.range.high);
    this.controls.enableRotate = !flat;
    this.controls.mouseButtons.LEFT = flat ? THREE.MOUSE.PAN : THREE.MOUSE.ROTATE;
    this.controls.touches.ONE = flat ? THREE.TOUCH.PAN : THREE.TOUCH.ROTATE;
    if (!this.fitted || (isNew && !this.touched && this.outgrown())) this.fit();
    this.dirty = true;
  }

  /// Whether the frame is larger than the view was made for.
  private outgrown(): boolean {
    const [right, up, back] = [0, 1, 2].map((k) => new THREE.Vector3().setFromMatrixColumn(this.camera.matrixWorld, k).toArray());
    return this.distanceToFit({ right: right!, up: up!, back: back! }) > this.camera.position.distanceTo(this.controls.target);
  }

  /// Of balls their own; particles without one are small beside their distance from each other, unless they are all there is of a film.
  private radii(frame: Frame, size: number): Float32Array {
    if (!frame.points) return new Float32Array(0);
    const count = frame.points.position.length / 3;
    const share = !frame.films && thicknessField(frame, "points") ? 0.5 : 0.2;
    return frame.points.radius ?? new Float32Array(count).fill((share * size) / Math.sqrt(count));
  }

  private setBounds(frame: Frame): void {
    this.bounds.makeEmpty();
    const point = new THREE.Vector3();
    for (const positions of [frame.films?.position, frame.points?.position])
      for (let i = 0; positions && i < positions.length; i += 3) this.bounds.expandByPoint(point.fromArray(positions, i));
    if (frame.box) {
      this.bounds.expandByPoint(point.fromArray(frame.box.origin));
      this.bounds.expandByPoint(point.fromArray(frame.box.origin.map((x, k) => x + (frame.box?.lengths[k] ?? 0))));
    }
  }

  private showBox(box: Box | null): void {
    this.boxLines.visible = box !== null;
    if (!box) return;
    const size = new THREE.Vector3(...box.lengths);
    this.boxLines.geometry.dispose();
    this.boxLines.geometry = new THREE.EdgesGeometry(new THREE.BoxGeometry(size.x, size.y, Math.max(size.z, 1e-9 * size.x)));
    this.boxLines.position.set(...box.origin).addScaledVector(size, 0.5);
  }

  /// What title and legend take of the height [px].
  private taken(): { titles: number; legends: number } {
    const share = Math.min(1, this.canvas.clientHeight / 400);
    return { titles: 64 * share, legends: 84 * share };
  }

  private distanceToFit(axes: Axes): number {
    if (!this.frame) return 1;
    const half = Math.tan((this.camera.fov * Math.PI) / 360);
    const { titles, legends } = this.taken();
    const tall = half * Math.max(0.2, 1 - (titles + legends) / Math.max(this.canvas.clientHeight, 1));
    const center = this.bounds.getCenter(new THREE.Vector3()).toArray();
    return Math.max(distanceToFit(this.frame, this.radius, center, axes, half * this.camera.aspect, tall), 1e-9);
  }

  /// The whole frame into view.
  fit(): void {
    if (this.bounds.isEmpty()) return;
    if (!this.frame) return;
    const flat = this.frame.box?.dimension === 2;
    const axes = usualAxes(this.frame);
    const distance = MARGIN * this.distanceToFit(axes);
    this.bounds.getCenter(this.controls.target);
    this.camera.position.copy(this.controls.target).addScaledVector(new THREE.Vector3(...axes.back), distance);
    if (flat) this.camera.position.y -= 1e-6 * distance; // the pole itself does not know where up is
    this.camera.near = distance / 100;
    this.camera.far = distance * 100;
    this.camera.updateProjectionMatrix();
    this.controls.update();
    this.fittedAt.copy(this.camera.position);
    this.fitted = true;
    this.dirty = true;
  }

  /// Keeps `share` of the frame's extent along an axis, and cuts away the side that is now nearer to the eye; null: nothing.
  cut(axis: 0 | 1 | 2 | null, share: number): void {
    if (axis === null) {
      this.cutAxis = null;
      this.clip.set(...NOTHING_CUT);
    } else {
      if (axis !== this.cutAxis?.axis)
        this.cutAxis = { axis, side: this.camera.position.getComponent(axis) < this.controls.target.getComponent(axis) ? -1 : 1 };
      const { side } = this.cutAxis;
      const low = this.bounds.min.getComponent(axis);
      const high = this.bounds.max.getComponent(axis);
      const reach = share * (high - low);
      this.clip.set(0, 0, 0, side > 0 ? low + reach : reach - high).setComponent(axis, side);
    }
    this.dirty = true;
  }

  pick(clientX: number, clientY: number): Pick {
    if (!this.frame) return null;
    const rect = this.canvas.getBoundingClientRect();
    const at = new THREE.Vector2((2 * (clientX - rect.left)) / rect.width - 1, 1 - (2 * (clientY - rect.top)) / rect.height);
    const caster = new THREE.Raycaster();
    caster.setFromCamera(at, this.camera);
    const ray: Ray = { origin: caster.ray.origin.toArray(), direction: caster.ray.direction.toArray() };
    const plane: Plane = this.clip.toArray();
    if (this.frame.films) {
      const region = pickRegion(this.frame.films, ray, plane);
      if (region > 0) return { kind: "region", region };
    }
    if (this.frame.points && this.balls.object.visible) {
      const index = pickBall(this.frame.points, this.radius, ray, plane, this.frame.box?.dimension === 2);
      if (index >= 0) return { kind: "ball", index };
    }
    return null;
  }

  /// Marks a bubble: a region (0: none) or a ball (-1: none).
  highlight(region: number, ball: number): void {
    this.films.pick(region);
    this.balls.pick(ball);
    this.dirty = true;
  }

  picture(): Promise<Blob> {
    this.draw(1); // in the same task as reading it: the buffer is not kept
    return new Promise((resolve, reject) =>
      this.canvas.toBlob((blob) => (blob ? resolve(blob) : reject(new Error("the browser could not make a picture"))), "image/png"),
    );
  }
}
