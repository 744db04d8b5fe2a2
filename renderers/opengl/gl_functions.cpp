#include "renderers/opengl/gl_functions.h"

#include <string>

#include "renderers/contract/devices.h"

namespace renderers::opengl {

namespace {

/// Looks entry points up by name.
class Loader {
 public:
  explicit Loader(const AddressOf& address_of) : address_of_(address_of) {}

  template <typename Pointer>
  void operator()(Pointer& entry, const char* name) const {
    entry = reinterpret_cast<Pointer>(address_of_(name));
    if (entry == nullptr) {
      throw UnsupportedError("the driver lacks the OpenGL 4.5 entry point " + std::string(name));
    }
  }

 private:
  const AddressOf& address_of_;
};

void load_state_and_errors(Functions& gl, const Loader& load) {
  load(gl.Enable, "glEnable");
  load(gl.Disable, "glDisable");
  load(gl.Finish, "glFinish");
  load(gl.GetError, "glGetError");
  load(gl.GetGraphicsResetStatus, "glGetGraphicsResetStatus");
  load(gl.GetIntegerv, "glGetIntegerv");
  load(gl.GetIntegeri_v, "glGetIntegeri_v");
  load(gl.GetString, "glGetString");
  load(gl.GetStringi, "glGetStringi");
  load(gl.ClipControl, "glClipControl");
  load(gl.DebugMessageCallback, "glDebugMessageCallback");
  load(gl.DebugMessageControl, "glDebugMessageControl");
  load(gl.BlendFunc, "glBlendFunc");
  load(gl.DepthFunc, "glDepthFunc");
  load(gl.DepthMask, "glDepthMask");
  load(gl.Viewport, "glViewport");
}

void load_buffers(Functions& gl, const Loader& load) {
  load(gl.BindBuffer, "glBindBuffer");
  load(gl.BindBufferBase, "glBindBufferBase");
  load(gl.ClearNamedBufferData, "glClearNamedBufferData");
  load(gl.CreateBuffers, "glCreateBuffers");
  load(gl.DeleteBuffers, "glDeleteBuffers");
  load(gl.GetNamedBufferSubData, "glGetNamedBufferSubData");
  load(gl.NamedBufferStorage, "glNamedBufferStorage");
  load(gl.NamedBufferSubData, "glNamedBufferSubData");
}

void load_textures(Functions& gl, const Loader& load) {
  load(gl.BindImageTexture, "glBindImageTexture");
  load(gl.BindTextureUnit, "glBindTextureUnit");
  load(gl.ClearTexImage, "glClearTexImage");
  load(gl.CreateTextures, "glCreateTextures");
  load(gl.DeleteTextures, "glDeleteTextures");
  load(gl.GetTextureImage, "glGetTextureImage");
  load(gl.GetTextureSubImage, "glGetTextureSubImage");
  load(gl.TextureParameteri, "glTextureParameteri");
  load(gl.TextureStorage2D, "glTextureStorage2D");
  load(gl.TextureStorage3D, "glTextureStorage3D");
  load(gl.TextureSubImage2D, "glTextureSubImage2D");
  load(gl.TextureSubImage3D, "glTextureSubImage3D");
}

void load_programs(Functions& gl, const Loader& load) {
  load(gl.AttachShader, "glAttachShader");
  load(gl.CompileShader, "glCompileShader");
  load(gl.CreateProgram, "glCreateProgram");
  load(gl.CreateShader, "glCreateShader");
  load(gl.DeleteProgram, "glDeleteProgram");
  load(gl.DeleteShader, "glDeleteShader");
  load(gl.DetachShader, "glDetachShader");
  load(gl.DispatchCompute, "glDispatchCompute");
  load(gl.DrawArraysIndirect, "glDrawArraysIndirect");
  load(gl.DrawArraysInstanced, "glDrawArraysInstanced");
  load(gl.DrawElementsInstanced, "glDrawElementsInstanced");
  load(gl.GetProgramInfoLog, "glGetProgramInfoLog");
  load(gl.GetProgramiv, "glGetProgramiv");
  load(gl.GetShaderInfoLog, "glGetShaderInfoLog");
  load(gl.GetShaderiv, "glGetShaderiv");
  load(gl.GetUniformLocation, "glGetUniformLocation");
  load(gl.LinkProgram, "glLinkProgram");
  load(gl.MemoryBarrier, "glMemoryBarrier");
  load(gl.ProgramUniform1f, "glProgramUniform1f");
  load(gl.ProgramUniform1i, "glProgramUniform1i");
  load(gl.ProgramUniform1ui, "glProgramUniform1ui");
  load(gl.ProgramUniform2fv, "glProgramUniform2fv");
  load(gl.ProgramUniform2iv, "glProgramUniform2iv");
  load(gl.ProgramUniform3fv, "glProgramUniform3fv");
  load(gl.ProgramUniform4fv, "glProgramUniform4fv");
  load(gl.ProgramUniformMatrix4fv, "glProgramUniformMatrix4fv");
  load(gl.ShaderSource, "glShaderSource");
  load(gl.UseProgram, "glUseProgram");
}

void load_targets(Functions& gl, const Loader& load) {
  load(gl.BindFramebuffer, "glBindFramebuffer");
  load(gl.BindVertexArray, "glBindVertexArray");
  load(gl.CheckNamedFramebufferStatus, "glCheckNamedFramebufferStatus");
  load(gl.ClearNamedFramebufferfv, "glClearNamedFramebufferfv");
  load(gl.CreateFramebuffers, "glCreateFramebuffers");
  load(gl.CreateVertexArrays, "glCreateVertexArrays");
  load(gl.DeleteFramebuffers, "glDeleteFramebuffers");
  load(gl.DeleteVertexArrays, "glDeleteVertexArrays");
  load(gl.NamedFramebufferDrawBuffer, "glNamedFramebufferDrawBuffer");
  load(gl.NamedFramebufferDrawBuffers, "glNamedFramebufferDrawBuffers");
  load(gl.NamedFramebufferParameteri, "glNamedFramebufferParameteri");
  load(gl.NamedFramebufferTexture, "glNamedFramebufferTexture");
  load(gl.NamedFramebufferTextureLayer, "glNamedFramebufferTextureLayer");
}

void load_queries(Functions& gl, const Loader& load) {
  load(gl.CreateQueries, "glCreateQueries");
  load(gl.DeleteQueries, "glDeleteQueries");
  load(gl.GetQueryObjectui64v, "glGetQueryObjectui64v");
  load(gl.QueryCounter, "glQueryCounter");
}

}  // namespace

Functions load_functions(const AddressOf& address_of) {
  Functions gl;
  const Loader load(address_of);
  load_state_and_errors(gl, load);
  load_buffers(gl, load);
  load_textures(gl, load);
  load_programs(gl, load);
  load_targets(gl, load);
  load_queries(gl, load);
  return gl;
}

}  // namespace renderers::opengl
