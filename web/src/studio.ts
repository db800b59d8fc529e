// The room that films, borders and balls reflect, which turns with the camera: a light tent with a window behind the
// eye, black cloth behind the films. GLSL.

export const STUDIO = /* glsl */ `
float softBox(vec2 p, vec2 center, vec2 size, float blur) {
  vec2 d = abs(p - center) - size;
  return (1.0 - smoothstep(-blur, blur, d.x)) * (1.0 - smoothstep(-blur, blur, d.y));
}

// Radiance from direction d as the camera has it (x right, y up, z to the eye), 1 being white paper in this light.
vec3 studio(vec3 d) {
  float up = 0.5 + 0.5 * d.y;
  vec3 light = mix(vec3(0.55, 0.50, 0.46), vec3(3.3, 3.5, 3.8), smoothstep(0.12, 1.0, up));
  vec2 front = d.xy / (abs(d.z) + 0.35);
  light *= mix(0.10, 1.0, smoothstep(-0.85, 0.35, d.z));
  float side = smoothstep(-0.6, 0.1, d.z);
  float window = softBox(front, vec2(-0.72, 0.78), vec2(0.34, 0.42), 0.03);
  window *= 1.0 - 0.85 * softBox(front, vec2(-0.72, 0.78), vec2(0.018, 0.6), 0.012);
  window *= 1.0 - 0.85 * softBox(front, vec2(-0.72, 0.76), vec2(0.6, 0.018), 0.012);
  light += side * 7.5 * window * vec3(1.0, 0.98, 0.95);
  light += side * 5.0 * softBox(front, vec2(1.35, 0.15), vec2(0.16, 0.95), 0.12) * vec3(1.0, 0.92, 0.82);
  return light;
}
`;
