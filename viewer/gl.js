// WebGL2 helpers: programs, buffers, attributes, shadow maps.

// a program and the locations of its uniforms, by name (`at`)
export function program(gl, vertex, fragment) {
  const handle = gl.createProgram();
  for (const [type, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(type);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS) && !gl.isContextLost()) {
      throw new Error(`shader compilation failed: ${gl.getShaderInfoLog(shader)}`);
    }
    gl.attachShader(handle, shader);
  }
  gl.linkProgram(handle);
  if (!gl.getProgramParameter(handle, gl.LINK_STATUS) && !gl.isContextLost()) {
    throw new Error(`program linking failed: ${gl.getProgramInfoLog(handle)}`);
  }
  const at = {};
  const count = gl.getProgramParameter(handle, gl.ACTIVE_UNIFORMS) ?? 0;
  for (let i = 0; i < count; i++) {
    const { name } = gl.getActiveUniform(handle, i);
    at[name.replace('[0]', '')] = gl.getUniformLocation(handle, name);
  }
  return { handle, at };
}

export function buffer(gl, data, target = gl.ARRAY_BUFFER, usage = gl.STATIC_DRAW) {
  const handle = gl.createBuffer();
  gl.bindBuffer(target, handle);
  gl.bufferData(target, data, usage);
  return handle;
}

// attribute `index`: `size` floats at `offset`, every `stride` bytes, per vertex or per instance
export function attribute(gl, index, size, stride, offset, perInstance = false) {
  gl.enableVertexAttribArray(index);
  gl.vertexAttribPointer(index, size, gl.FLOAT, false, stride, offset);
  gl.vertexAttribDivisor(index, perInstance ? 1 : 0);
}

// a depth texture with its framebuffer
export function createShadowMap(gl, size) {
  const texture = gl.createTexture();
  gl.bindTexture(gl.TEXTURE_2D, texture);
  gl.texStorage2D(gl.TEXTURE_2D, 1, gl.DEPTH_COMPONENT24, size, size);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_COMPARE_MODE, gl.COMPARE_REF_TO_TEXTURE);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_COMPARE_FUNC, gl.LEQUAL);
  for (const key of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, key, gl.LINEAR);
  for (const key of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.texParameteri(gl.TEXTURE_2D, key, gl.CLAMP_TO_EDGE);
  const framebuffer = gl.createFramebuffer();
  gl.bindFramebuffer(gl.FRAMEBUFFER, framebuffer);
  gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.TEXTURE_2D, texture, 0);
  gl.drawBuffers([gl.NONE]);
  gl.readBuffer(gl.NONE);
  gl.bindFramebuffer(gl.FRAMEBUFFER, null);
  return { texture, framebuffer, size };
}

export function deleteShadowMap(gl, map) {
  gl.deleteFramebuffer(map.framebuffer);
  gl.deleteTexture(map.texture);
}

// uses a program and sets the uniforms that depend on camera, light and theme
export function useProgram(gl, { handle, at }, view) {
  gl.useProgram(handle);
  if (at.viewProjection) gl.uniformMatrix4fv(at.viewProjection, false, view.matrix);
  if (at.eye) gl.uniform3fv(at.eye, view.eye);
  if (at.up) gl.uniform3fv(at.up, view.up);
  if (at.viewport) gl.uniform2f(at.viewport, view.width, view.height);
  if (at.sun) gl.uniform3fv(at.sun, view.sun);
  const { theme } = view;
  if (at.skyColour) gl.uniform3fv(at.skyColour, theme.sky);
  if (at.groundColour) gl.uniform3fv(at.groundColour, theme.ground);
  if (at.sunColour) gl.uniform3fv(at.sunColour, theme.sun);
  if (at.lightMatrix) {
    gl.uniformMatrix4fv(at.lightMatrix, false, view.lightMatrix);
    gl.uniform1i(at.shadowMap, 0);
    gl.uniform1i(at.taps, view.taps);
    gl.uniform1f(at.softness, view.softness);
    gl.uniform1f(at.texel, view.texel);
  }
}
