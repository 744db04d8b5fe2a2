// ---- WebGL2: one pass makes the display texture of an image, at the image's own size, when
// exposure, curve or mode changes; another draws display textures wherever they are to be seen.

const kVertexShader = `#version 300 es
// A rectangle in clip space. u_rect: left, bottom, right, top.
uniform vec4 u_rect;
out vec2 v_at;
void main() {
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
  v_at = corner;
  gl_Position = vec4(mix(u_rect.xy, u_rect.zw, corner), 0.0, 1.0);
}`;

const kDisplayShader = `#version 300 es
// Half-floats to 8-bit colours. Row 0 of the texture is the image's top row.
precision highp float;
precision highp int;
precision highp usampler2D;
uniform usampler2D u_test;       // bits of half-floats: R, or R, G, B
uniform usampler2D u_reference;  // likewise; of differences only
uniform sampler2D u_tone;        // 256 x 256: sRGB byte of every half-float
uniform sampler2D u_colors;      // 256 x 1
uniform float u_test_scale;
uniform float u_reference_scale;
uniform int u_mode;              // 0 image, 1 map, 2 signed, 3 absolute, 4 relative, 5 squared
uniform bool u_is_gray;
uniform vec3 u_scale;            // low, high, 1 if logarithmic
out vec4 color;

bool is_finite_half(uvec3 bits) {
  return all(notEqual(bits & uvec3(0x7c00u), uvec3(0x7c00u)));
}
vec3 values(uvec3 bits) {
  return vec3(unpackHalf2x16(bits.r).x, unpackHalf2x16(bits.g).x, unpackHalf2x16(bits.b).x);
}
float tone(uint bits) {
  return texelFetch(u_tone, ivec2(int(bits & 255u), int(bits >> 8u)), 0).r;
}
float difference(vec3 x, vec3 r) {
  vec3 d = x - r;
  vec3 third = vec3(1.0 / 3.0);
  if (u_mode == 2) return dot(d, vec3(0.2126, 0.7152, 0.0722));
  if (u_mode == 3) return dot(abs(d), third);
  if (u_mode == 4) return dot(abs(d) / (abs(r) + 0.01), third);
  return dot(d * d, third);
}
float position(float value) {
  if (u_mode == 2) {
    float size = abs(value);
    if (size <= u_scale.x) return 0.5;
    return 0.5 + 0.5 * sign(value) * min(1.0, log(size / u_scale.x) / log(u_scale.y / u_scale.x));
  }
  if (value <= u_scale.x) return 0.0;
  if (value >= u_scale.y) return 1.0;
  return u_scale.z > 0.5 ? log(value / u_scale.x) / log(u_scale.y / u_scale.x)
                         : (value - u_scale.x) / (u_scale.y - u_scale.x);
}
void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  uvec3 bits = texelFetch(u_test, at, 0).rgb;
  if (u_is_gray) bits = bits.rrr;
  uvec3 reference = u_mode >= 2 ? texelFetch(u_reference, at, 0).rgb : uvec3(0u);
  if (!is_finite_half(bits) || !is_finite_half(reference)) {
    color = vec4(0.0, 1.0, 1.0, 1.0);
  } else if (u_mode == 0) {
    color = vec4(tone(bits.r), tone(bits.g), tone(bits.b), 1.0);
  } else {
    float value = values(bits).r * u_test_scale;
    if (u_mode >= 2) {
      value = difference(values(bits) * u_test_scale, values(reference) * u_reference_scale);
    }
    color = texelFetch(u_colors, ivec2(int(position(value) * 255.0 + 0.5), 0), 0);
  }
}`;

const kDrawShader = `#version 300 es
// A display texture, as it is.
precision highp float;
uniform sampler2D u_display;
in vec2 v_at;
out vec4 color;
void main() { color = vec4(texture(u_display, vec2(v_at.x, 1.0 - v_at.y)).rgb, 1.0); }`;

const kGlModes = {image: 0, map: 1, signed: 2, absolute: 3, relative: 4, squared: 5};

class GlPainter {
  // Throws an Error if there is no WebGL2.
  constructor(canvas) {
    const gl = canvas.getContext('webgl2', {antialias: false});
    if (!gl) throw new Error('this browser has no WebGL2');
    this.gl = gl;
    this.canvas = canvas;
    this.name = 'WebGL2';
    this.displayRuns = 0;
    this.display = this.program(kDisplayShader);
    this.drawing = this.program(kDrawShader);
    this.frame = gl.createFramebuffer();
    this.halfTextures = new Map();
    this.colorTextures = {};
    for (const [name, table] of Object.entries(colorTables)) {
      if (table) this.colorTextures[name] = this.byteTexture(new Uint8Array(table), 256, 1);
    }
    gl.bindVertexArray(gl.createVertexArray());
  }

  program(fragment) {
    const gl = this.gl;
    const program = gl.createProgram();
    for (const [type, text] of [[gl.VERTEX_SHADER, kVertexShader], [gl.FRAGMENT_SHADER, fragment]]) {
      const shader = gl.createShader(type);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) {
      const logs = gl.getAttachedShaders(program).map(shader => gl.getShaderInfoLog(shader));
      throw new Error('a shader of the viewer was refused: ' + logs.join('\n'));
    }
    const uniforms = {};
    for (let i = gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS) - 1; i >= 0; --i) {
      const {name} = gl.getActiveUniform(program, i);
      uniforms[name] = gl.getUniformLocation(program, name);
    }
    return {program, uniforms};
  }

  texture(filter) {
    const gl = this.gl;
    const texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, filter);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, filter);
    return texture;
  }

  byteTexture(bytes, width, height) {
    const gl = this.gl;
    const texture = this.texture(gl.NEAREST);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8, width, height, 0, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
    return texture;
  }

  // The bits of a float image as a texture; the last few are kept.
  halfTexture(image) {
    const gl = this.gl;
    const known = this.halfTextures.get(image);
    if (known) return known;
    if (this.halfTextures.size >= 8) {
      const [oldest, texture] = this.halfTextures.entries().next().value;
      gl.deleteTexture(texture);
      this.halfTextures.delete(oldest);
    }
    const most = gl.getParameter(gl.MAX_TEXTURE_SIZE);
    if (image.width > most || image.height > most) {
      throw new Error(`WebGL2 holds at most ${most} x ${most} pixels`);
    }
    const texture = this.texture(gl.NEAREST);
    const isGray = image.channels === 1;
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    gl.texImage2D(gl.TEXTURE_2D, 0, isGray ? gl.R16UI : gl.RGB16UI, image.width, image.height, 0,
                  isGray ? gl.RED_INTEGER : gl.RGB_INTEGER, gl.UNSIGNED_SHORT, image.halfs);
    this.halfTextures.set(image, texture);
    return texture;
  }

  // A display texture of a job; see displayJob().
  makeDisplay(job) {
    const gl = this.gl;
    const {program, uniforms} = this.display;
    ++this.displayRuns;
    const {width, height} = job.test;
    const tone = job.tone ? this.toneTexture(job.tone) : null;
    const test = this.halfTexture(job.test);
    const reference = job.reference ? this.halfTexture(job.reference) : test;
    const texture = this.emptyDisplay(width, height);
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.frame);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, texture, 0);
    gl.disable(gl.SCISSOR_TEST);
    gl.viewport(0, 0, width, height);
    gl.useProgram(program);
    const colors = this.colorTextures[job.table] || this.colorTextures.signed;
    [test, reference, tone || colors, colors].forEach((one, unit) => {
      gl.activeTexture(gl.TEXTURE0 + unit);
      gl.bindTexture(gl.TEXTURE_2D, one);
    });
    gl.uniform1i(uniforms.u_test, 0);
    gl.uniform1i(uniforms.u_reference, 1);
    gl.uniform1i(uniforms.u_tone, 2);
    gl.uniform1i(uniforms.u_colors, 3);
    gl.uniform1f(uniforms.u_test_scale, job.test.scale);
    gl.uniform1f(uniforms.u_reference_scale, job.reference ? job.reference.scale : 1);
    gl.uniform1i(uniforms.u_mode, kGlModes[job.kind]);
    gl.uniform1i(uniforms.u_is_gray, job.test.channels === 1 ? 1 : 0);
    const scale = job.scale || {low: 0, high: 1, logarithmic: false};
    gl.uniform3f(uniforms.u_scale, scale.low, scale.high, scale.logarithmic ? 1 : 0);
    gl.uniform4f(uniforms.u_rect, -1, -1, 1, 1);
    gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    if (tone) gl.deleteTexture(tone);
    return this.finished(texture, width, height);
  }

  toneTexture(bytes) {
    const gl = this.gl;
    const texture = this.texture(gl.NEAREST);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.R8, 256, 256, 0, gl.RED, gl.UNSIGNED_BYTE, bytes);
    return texture;
  }

  emptyDisplay(width, height) {
    const gl = this.gl;
    gl.activeTexture(gl.TEXTURE0);
    const texture = this.texture(gl.LINEAR);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8, width, height, 0, gl.RGBA, gl.UNSIGNED_BYTE, null);
    return texture;
  }

  finished(texture, width, height) {
    const gl = this.gl;
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.generateMipmap(gl.TEXTURE_2D);
    return {texture, width, height, bytes: 5.4 * width * height};
  }

  // A display of an 8-bit picture; null if it may not be read (a file beside the page).
  pictureDisplay(element) {
    const gl = this.gl;
    const width = element.naturalWidth;
    const height = element.naturalHeight;
    const texture = this.emptyDisplay(width, height);
    try {
      gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8, gl.RGBA, gl.UNSIGNED_BYTE, element);
    } catch (error) {
      gl.deleteTexture(texture);
      return null;
    }
    return this.finished(texture, width, height);
  }

  dropDisplay(display) { this.gl.deleteTexture(display.texture); }

  // Sizes and places are in pixels of the canvas, from its top left.
  begin(width, height) {
    const gl = this.gl;
    if (this.canvas.width !== width) this.canvas.width = width;
    if (this.canvas.height !== height) this.canvas.height = height;
    gl.disable(gl.SCISSOR_TEST);
    gl.viewport(0, 0, width, height);
    gl.clearColor(0.063, 0.07, 0.078, 1);
    gl.clear(gl.COLOR_BUFFER_BIT);
  }

  draw(display, place, clip, isSmooth) {
    const gl = this.gl;
    const {width, height} = this.canvas;
    const {program, uniforms} = this.drawing;
    gl.viewport(0, 0, width, height);
    gl.enable(gl.SCISSOR_TEST);
    gl.scissor(Math.round(clip.x), Math.round(height - clip.y - clip.height),
               Math.max(0, Math.round(clip.width)), Math.max(0, Math.round(clip.height)));
    gl.useProgram(program);
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, display.texture);
    const isLarge = place.width >= display.width;
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, isSmooth ? gl.LINEAR : gl.NEAREST);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER,
                     isLarge ? gl.NEAREST : gl.LINEAR_MIPMAP_LINEAR);
    gl.uniform1i(uniforms.u_display, 0);
    const x = v => 2 * v / width - 1;
    const y = v => 1 - 2 * v / height;
    gl.uniform4f(uniforms.u_rect, x(place.x), y(place.y + place.height), x(place.x + place.width),
                 y(place.y));
    gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
  }
}
