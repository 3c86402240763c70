// OpenGL's functions, as GLEW declares them. The only file that includes glew.h, which must come
// before any other GL header and undefines what osmesa.h needs: never include both.
#pragma once

#define GLEW_NO_GLU
#include <GL/glew.h>
