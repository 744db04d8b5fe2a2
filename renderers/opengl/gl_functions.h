#pragma once

#include <functional>

#include <GL/glcorearb.h>

namespace renderers::opengl {

/// Entry points of one context, named as in OpenGL without "gl". Those of two platforms differ and
/// are never mixed. Internal: third-party types.
struct Functions {
  // State and errors
  PFNGLENABLEPROC Enable = nullptr;
  PFNGLDISABLEPROC Disable = nullptr;
  PFNGLFINISHPROC Finish = nullptr;
  PFNGLGETERRORPROC GetError = nullptr;
  PFNGLGETGRAPHICSRESETSTATUSPROC GetGraphicsResetStatus = nullptr;
  PFNGLGETINTEGERVPROC GetIntegerv = nullptr;
  PFNGLGETINTEGERI_VPROC GetIntegeri_v = nullptr;
  PFNGLGETSTRINGPROC GetString = nullptr;
  PFNGLGETSTRINGIPROC GetStringi = nullptr;
  PFNGLCLIPCONTROLPROC ClipControl = nullptr;
  PFNGLDEBUGMESSAGECALLBACKPROC DebugMessageCallback = nullptr;
  PFNGLDEBUGMESSAGECONTROLPROC DebugMessageControl = nullptr;
  PFNGLBLENDFUNCPROC BlendFunc = nullptr;
  PFNGLDEPTHFUNCPROC DepthFunc = nullptr;
  PFNGLDEPTHMASKPROC DepthMask = nullptr;
  PFNGLVIEWPORTPROC Viewport = nullptr;
  // Buffers
  PFNGLBINDBUFFERPROC BindBuffer = nullptr;
  PFNGLBINDBUFFERBASEPROC BindBufferBase = nullptr;
  PFNGLCLEARNAMEDBUFFERDATAPROC ClearNamedBufferData = nullptr;
  PFNGLCREATEBUFFERSPROC CreateBuffers = nullptr;
  PFNGLDELETEBUFFERSPROC DeleteBuffers = nullptr;
  PFNGLGETNAMEDBUFFERSUBDATAPROC GetNamedBufferSubData = nullptr;
  PFNGLNAMEDBUFFERSTORAGEPROC NamedBufferStorage = nullptr;
  PFNGLNAMEDBUFFERSUBDATAPROC NamedBufferSubData = nullptr;
  // Textures
  PFNGLBINDIMAGETEXTUREPROC BindImageTexture = nullptr;
  PFNGLBINDTEXTUREUNITPROC BindTextureUnit = nullptr;
  PFNGLCLEARTEXIMAGEPROC ClearTexImage = nullptr;
  PFNGLCREATETEXTURESPROC CreateTextures = nullptr;
  PFNGLDELETETEXTURESPROC DeleteTextures = nullptr;
  PFNGLGETTEXTUREIMAGEPROC GetTextureImage = nullptr;
  PFNGLGETTEXTURESUBIMAGEPROC GetTextureSubImage = nullptr;
  PFNGLTEXTUREPARAMETERIPROC TextureParameteri = nullptr;
  PFNGLTEXTURESTORAGE2DPROC TextureStorage2D = nullptr;
  PFNGLTEXTURESTORAGE3DPROC TextureStorage3D = nullptr;
  PFNGLTEXTURESUBIMAGE2DPROC TextureSubImage2D = nullptr;
  PFNGLTEXTURESUBIMAGE3DPROC TextureSubImage3D = nullptr;
  // Programs
  PFNGLATTACHSHADERPROC AttachShader = nullptr;
  PFNGLCOMPILESHADERPROC CompileShader = nullptr;
  PFNGLCREATEPROGRAMPROC CreateProgram = nullptr;
  PFNGLCREATESHADERPROC CreateShader = nullptr;
  PFNGLDELETEPROGRAMPROC DeleteProgram = nullptr;
  PFNGLDELETESHADERPROC DeleteShader = nullptr;
  PFNGLDETACHSHADERPROC DetachShader = nullptr;
  PFNGLDISPATCHCOMPUTEPROC DispatchCompute = nullptr;
  PFNGLDRAWARRAYSINDIRECTPROC DrawArraysIndirect = nullptr;
  PFNGLDRAWARRAYSINSTANCEDPROC DrawArraysInstanced = nullptr;
  PFNGLDRAWELEMENTSINSTANCEDPROC DrawElementsInstanced = nullptr;
  PFNGLGETPROGRAMINFOLOGPROC GetProgramInfoLog = nullptr;
  PFNGLGETPROGRAMIVPROC GetProgramiv = nullptr;
  PFNGLGETSHADERINFOLOGPROC GetShaderInfoLog = nullptr;
  PFNGLGETSHADERIVPROC GetShaderiv = nullptr;
  PFNGLGETUNIFORMLOCATIONPROC GetUniformLocation = nullptr;
  PFNGLLINKPROGRAMPROC LinkProgram = nullptr;
  PFNGLMEMORYBARRIERPROC MemoryBarrier = nullptr;
  PFNGLPROGRAMUNIFORM1FPROC ProgramUniform1f = nullptr;
  PFNGLPROGRAMUNIFORM1IPROC ProgramUniform1i = nullptr;
  PFNGLPROGRAMUNIFORM1UIPROC ProgramUniform1ui = nullptr;
  PFNGLPROGRAMUNIFORM2FVPROC ProgramUniform2fv = nullptr;
  PFNGLPROGRAMUNIFORM2IVPROC ProgramUniform2iv = nullptr;
  PFNGLPROGRAMUNIFORM3FVPROC ProgramUniform3fv = nullptr;
  PFNGLPROGRAMUNIFORM4FVPROC ProgramUniform4fv = nullptr;
  PFNGLPROGRAMUNIFORMMATRIX4FVPROC ProgramUniformMatrix4fv = nullptr;
  PFNGLSHADERSOURCEPROC ShaderSource = nullptr;
  PFNGLUSEPROGRAMPROC UseProgram = nullptr;
  // Targets
  PFNGLBINDFRAMEBUFFERPROC BindFramebuffer = nullptr;
  PFNGLBINDVERTEXARRAYPROC BindVertexArray = nullptr;
  PFNGLCHECKNAMEDFRAMEBUFFERSTATUSPROC CheckNamedFramebufferStatus = nullptr;
  PFNGLCLEARNAMEDFRAMEBUFFERFVPROC ClearNamedFramebufferfv = nullptr;
  PFNGLCREATEFRAMEBUFFERSPROC CreateFramebuffers = nullptr;
  PFNGLCREATEVERTEXARRAYSPROC CreateVertexArrays = nullptr;
  PFNGLDELETEFRAMEBUFFERSPROC DeleteFramebuffers = nullptr;
  PFNGLDELETEVERTEXARRAYSPROC DeleteVertexArrays = nullptr;
  PFNGLNAMEDFRAMEBUFFERDRAWBUFFERPROC NamedFramebufferDrawBuffer = nullptr;
  PFNGLNAMEDFRAMEBUFFERDRAWBUFFERSPROC NamedFramebufferDrawBuffers = nullptr;
  PFNGLNAMEDFRAMEBUFFERPARAMETERIPROC NamedFramebufferParameteri = nullptr;
  PFNGLNAMEDFRAMEBUFFERTEXTUREPROC NamedFramebufferTexture = nullptr;
  PFNGLNAMEDFRAMEBUFFERTEXTURELAYERPROC NamedFramebufferTextureLayer = nullptr;
  // Queries
  PFNGLCREATEQUERIESPROC CreateQueries = nullptr;
  PFNGLDELETEQUERIESPROC DeleteQueries = nullptr;
  PFNGLGETQUERYOBJECTUI64VPROC GetQueryObjectui64v = nullptr;
  PFNGLQUERYCOUNTERPROC QueryCounter = nullptr;
};

/// Address of an entry point by its full name, null if there is none.
using AddressOf = std::function<void (*(const char* name))()>;

/// @throws UnsupportedError naming a missing entry point
Functions load_functions(const AddressOf& address_of);

}  // namespace renderers::opengl
