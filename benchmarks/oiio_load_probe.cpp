// Loads OpenImageIO's library and ends: the least that a program which writes a picture through it can take.
#include <dlfcn.h>

#include <cstdio>

int main() {
  if (dlopen(RAYTREE_OIIO_LIBRARY, RTLD_LAZY | RTLD_LOCAL) != nullptr) return 0;
  std::fprintf(stderr, "%s\n", dlerror());
  return 1;
}
