// Many spheres at once: a square per sphere that faces the eye, and in each of its points the ray to the sphere's surface. Exact
// outlines and depths at four corners a sphere.
"use strict";
grandamp.spheres = (() => {
  const vertex = `
    attribute vec3 place;
    attribute float radius, value;
    uniform vec3 low, span;
    varying vec3 seen, centre;
    varying float reach, shade;
    void main() {
      centre = (modelViewMatrix * vec4(low + span * place, 1.0)).xyz;
      float distance_to = length(centre);
      vec3 ahead = centre / distance_to;
      vec3 right = normalize(cross(ahead, vec3(0.0, 1.0, 0.0)));
      float half_width = 1.02 * radius * distance_to / sqrt(max(distance_to * distance_to - radius * radius, 1e-12));
      seen = centre + half_width * (position.x * right + position.y * cross(right, ahead));
      reach = radius;
      shade = value;
      gl_Position = projectionMatrix * vec4(seen, 1.0);
    }`;
  const fragment = `
    precision highp float;
    uniform mat4 projectionMatrix;
    uniform sampler2D colours;
    varying vec3 seen, centre;
    varying float reach, shade;
    void main() {
      vec3 ray = normalize(seen);
      float along = dot(ray, centre);
      float inside = along * along - dot(centre, centre) + reach * reach;
      if (inside < 0.0) discard;
      vec3 hit = (along - sqrt(inside)) * ray;
      vec3 normal = (hit - centre) / reach;
      float light = 0.42 + 0.58 * max(dot(normal, normalize(vec3(0.35, 0.55, 0.75))), 0.0);
      light *= smoothstep(-0.05, 0.35, -dot(normal, ray)) * 0.35 + 0.65;
      vec4 clip = projectionMatrix * vec4(hit, 1.0);
      gl_FragDepthEXT = 0.5 * clip.z / clip.w + 0.5;
      gl_FragColor = vec4(texture2D(colours, vec2(shade, 0.5)).rgb * light, 1.0);
    }`;

  /** A texture of so many colours, from text like "#440154": between them smooth, or each by itself. */
  function texture(colours, smooth) {
    const size = smooth ? 256 : colours.length, bytes = new Uint8Array(4 * size);
    const parts = colours.map(hex => [1, 3, 5].map(k => parseInt(hex.substr(k, 2), 16)));
    for (let k = 0; k < size; ++k) {
      const at = smooth ? k / (size - 1) * (colours.length - 1) : k, below = Math.min(Math.floor(at), colours.length - 1);
      const above = Math.min(below + 1, colours.length - 1), share = at - below;
      for (let c = 0; c < 3; ++c) bytes[4 * k + c] = parts[below][c] + share * (parts[above][c] - parts[below][c]);
      bytes[4 * k + 3] = 255;
    }
    const made = new THREE.DataTexture(bytes, size, 1, THREE.RGBAFormat);
    made.magFilter = made.minFilter = smooth ? THREE.LinearFilter : THREE.NearestFilter;
    made.needsUpdate = true;
    return made;
  }

  /** Spheres of these radii; where they are and what they show is set for each picture. */
  function make(radii, low, span) {
    const geometry = new THREE.InstancedBufferGeometry(), count = radii.length;
    geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array([-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0]), 3));
    geometry.setIndex([0, 1, 2, 0, 2, 3]);
    const place = new THREE.InstancedBufferAttribute(new Uint16Array(3 * count), 3, true);
    const value = new THREE.InstancedBufferAttribute(new Uint8Array(count), 1, true);
    place.setUsage(THREE.DynamicDrawUsage);
    value.setUsage(THREE.DynamicDrawUsage);
    geometry.setAttribute("place", place);
    geometry.setAttribute("value", value);
    geometry.setAttribute("radius", new THREE.InstancedBufferAttribute(radii, 1));
    geometry.maxInstancedCount = count;
    const uniforms = { low: { value: new THREE.Vector3(...low) }, span: { value: new THREE.Vector3(...span) }, colours: { value: null } };
    const material = new THREE.ShaderMaterial({ uniforms, vertexShader: vertex, fragmentShader: fragment, side: THREE.DoubleSide, extensions: { fragDepth: true } });
    const mesh = new THREE.Mesh(geometry, material);
    mesh.frustumCulled = false;
    return { mesh,
      places(numbers) { place.array.set(numbers); place.needsUpdate = true; },
      values(numbers) { value.array.set(numbers); value.needsUpdate = true; },
      colours(colours, smooth) { uniforms.colours.value = texture(colours, smooth); } };
  }
  return { make };
})();
