// What crosses the border between the program and the modules raytree_image_io, raytree_exr_io and raytree_png_io:
// plain C types only, no exception and no C++ object, so that either side may be built on its own. Both sides check
// kRaytreeImageIoVersion.
#pragma once

#include <stddef.h>
#include <stdint.h>

extern "C" {

enum { kRaytreeImageIoVersion = 3 };

enum RaytreePixelType {
  kRaytreeUint8 = 0,
  kRaytreeUint16 = 1,
  kRaytreeHalf = 2,
  kRaytreeFloat32 = 3,
  kRaytreeUint32 = 4,
  kRaytreeOther = 5  // read only: handed over as float32
};

enum RaytreeImageFormat { kRaytreeExr = 0, kRaytreePng = 1, kRaytreeJpeg = 2, kRaytreeTiff = 3 };

// All text is UTF-8 and ends in 0.
struct RaytreeText {
  const char* name;
  const char* text;
};

struct RaytreePlane {
  const char* name;
  int type;            // RaytreePixelType in the file
  int source_type;     // RaytreePixelType of pixels
  const void* pixels;  // [height][width]
};

struct RaytreeImage {
  int frame_width, frame_height;
  int x0, y0, width, height;
  const RaytreePlane* planes;
  size_t plane_count;
  const RaytreeText* metadata;
  size_t metadata_count;
  const char* color_space;  // "linear_rec709", "srgb" or "" (not declared)
  int format;               // RaytreeImageFormat
  int threads;              // 0: as many as there are cores
};

// Calls that receive results; context is handed through. `bytes` live until the call returns.
typedef void (*RaytreeBytesSink)(void* context, const void* bytes, size_t size);
// The same of a file under way: bytes [offset, offset + size). In order, but for what is written again at the end.
// Returns 0 to stop the encoder.
typedef int (*RaytreeFileSink)(void* context, uint64_t offset, const void* bytes, size_t size);

struct RaytreeImageSink {
  void* context;
  // Called once, first. Returns 0 to refuse the picture (too large).
  int (*begin)(void* context, int frame_width, int frame_height, int x0, int y0, int width, int height,
               size_t plane_count);
  void (*plane)(void* context, size_t index, const char* name, int type);
  // Where rows [y, y + rows) of every plane go: interleaved pixels [rows][width][plane], 4 bytes a value: uint32 for
  // planes of type kRaytreeUint32, else float32.
  void (*rows)(void* context, int y, int rows, const void* values);
  void (*metadata)(void* context, const char* name, const char* text);
};

struct RaytreeImageIo {
  int version;
  // Each returns 1, or 0 after handing a message to `error`. half_clamped counts finite values beyond the largest half.
  // decode is null in all modules but raytree_image_io.
  int (*encode)(const RaytreeImage* image, RaytreeFileSink file, RaytreeBytesSink error, void* context,
                int64_t* half_clamped);
  int (*decode)(const char* path, const RaytreeImageSink* sink, RaytreeBytesSink error, void* error_context);
};

// The one symbol of each module.
const RaytreeImageIo* raytree_image_io();
}
