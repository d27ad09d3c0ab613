// The program's side of image files: picks the format, opens the module that knows it on demand, hands planes over and
// takes bytes or planes back. Writing to disk is atomic_file's.
#include "renderer/image_file.h"

#include <dlfcn.h>
#include <limits.h>
#include <tbb/global_control.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <mutex>
#include <string_view>
#include <system_error>
#include <thread>

#include "geometry/error.h"
#include "renderer/atomic_file.h"
#include "renderer/image_io/image_io.h"

namespace raytree {
namespace {

std::vector<std::string> module_candidates(const std::string& name) {
  if (const char* given = std::getenv("RAYTREE_MODULES"); given != nullptr && *given != '\0')
    return {std::string(given) + "/" + name};
  std::vector<std::string> paths;
  const auto add_around = [&](const std::string& folder) {
    for (const std::string_view place :
         {"/../lib/", "/../lib/raytree/", "/../" RAYTREE_INSTALL_LIBDIR "/raytree/", "/"}) {
      std::string path = folder + std::string(place) + name;
      if (std::find(paths.begin(), paths.end(), path) == paths.end()) paths.push_back(std::move(path));
    }
  };
  char text[PATH_MAX];
  const ssize_t size = ::readlink("/proc/self/exe", text, sizeof text);
  if (size > 0) {
    const std::string program(text, static_cast<std::size_t>(size));
    add_around(program.substr(0, program.find_last_of('/')));
  }
  // Where this code lies, should it have become part of a shared library.
  Dl_info info{};
  if (::dladdr(reinterpret_cast<const void*>(&image_format), &info) != 0 && info.dli_fname != nullptr) {
    const std::string library = info.dli_fname;
    if (const std::size_t slash = library.find_last_of('/'); slash != std::string::npos)
      add_around(library.substr(0, slash));
  }
  return paths;
}

// A module, opened once; never closed, since the libraries behind it keep threads.
class Module {
 public:
  explicit Module(std::string name) : name_(std::move(name)) {}
  ~Module() { wait(); }

  void preload() {
    const std::lock_guard lock(mutex_);
    if (loader_.joinable() || tried_) return;
    try {
      loader_ = std::thread([this] { load_once(); });
    } catch (const std::system_error&) {
      // No thread to be had: the first use loads.
    }
  }

  /// Until what was begun to load is there.
  void wait() {
    std::thread loader;
    {
      const std::lock_guard lock(mutex_);
      loader.swap(loader_);
    }
    if (loader.joinable()) loader.join();
  }

  const RaytreeImageIo& table() {
    load_once();
    if (table_ == nullptr) throw Error(ErrorKind::failure, {name_, 0, ""}, problem_);
    return *table_;
  }

 private:
  void load_once() {
    std::call_once(once_, [this] { load(); });
    const std::lock_guard lock(mutex_);
    tried_ = true;
  }

  void load() {
    problem_ = "the module for image files cannot be opened; tried";
    for (const std::string& path : module_candidates(name_)) {
      void* library = ::dlopen(path.c_str(), RTLD_LAZY | RTLD_LOCAL);
      if (library == nullptr) {
        const char* reason = ::dlerror();
        problem_ += "\n  " + std::string(reason != nullptr ? reason : path);
        continue;
      }
      const auto entry = reinterpret_cast<const RaytreeImageIo* (*)()>(::dlsym(library, "raytree_image_io"));
      const RaytreeImageIo* table = entry != nullptr ? entry() : nullptr;
      if (table == nullptr || table->version != kRaytreeImageIoVersion) {
        problem_ += "\n  " + path + ": of another version of Raytree";
        continue;
      }
      table_ = table;
      return;
    }
  }

  const std::string name_;
  std::mutex mutex_;
  std::once_flag once_;
  std::thread loader_;
  bool tried_ = false;
  const RaytreeImageIo* table_ = nullptr;
  std::string problem_;
};

/// Of all formats without a module of their own, and of reading.
Module& image_module() {
  static Module instance("raytree_image_io.so");
  return instance;
}

Module& exr_module() {
  static Module instance("raytree_exr_io.so");
  return instance;
}

Module& png_module() {
  static Module instance("raytree_png_io.so");
  return instance;
}

Module& encoding_module(ImageFormat format) {
  return format == ImageFormat::exr ? exr_module() : format == ImageFormat::png ? png_module() : image_module();
}

int module_type(PixelType type) {
  switch (type) {
    case PixelType::uint8:
      return kRaytreeUint8;
    case PixelType::uint16:
      return kRaytreeUint16;
    case PixelType::half:
      return kRaytreeHalf;
    case PixelType::float32:
      return kRaytreeFloat32;
    case PixelType::uint32:
      return kRaytreeUint32;
  }
  return kRaytreeOther;
}

PixelType pixel_type(int type) {
  switch (type) {
    case kRaytreeUint8:
      return PixelType::uint8;
    case kRaytreeUint16:
      return PixelType::uint16;
    case kRaytreeHalf:
      return PixelType::half;
    case kRaytreeUint32:
      return PixelType::uint32;
    default:
      return PixelType::float32;
  }
}

int module_format(ImageFormat format) {
  switch (format) {
    case ImageFormat::exr:
      return kRaytreeExr;
    case ImageFormat::png:
      return kRaytreePng;
    case ImageFormat::jpeg:
      return kRaytreeJpeg;
    case ImageFormat::tiff:
      return kRaytreeTiff;
  }
  return kRaytreeExr;
}

// Both sinks of encode() share one context. No exception may cross the module: what fails is kept.
struct Encoding {
  const ByteSink& sink;
  std::exception_ptr problem;  ///< what the sink threw
  std::string error;
};

}  // namespace

ImageFormat image_format(const std::string& path) {
  const std::size_t slash = path.find_last_of('/');
  const std::size_t dot = path.find_last_of('.');
  std::string extension;
  if (dot != std::string::npos && (slash == std::string::npos || dot > slash)) extension = path.substr(dot);
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (extension == ".exr") return ImageFormat::exr;
  if (extension == ".png") return ImageFormat::png;
  if (extension == ".jpg" || extension == ".jpeg") return ImageFormat::jpeg;
  if (extension == ".tif" || extension == ".tiff") return ImageFormat::tiff;
  throw Error(ErrorKind::bad_input, {path, 0, ""},
              (extension.empty() ? "no extension" : "unknown extension \"" + extension + "\"") +
                  std::string("; image files are .exr, .png, .jpg, .jpeg, .tif or .tiff"));
}

bool holds_alpha(ImageFormat format) { return format != ImageFormat::jpeg; }

void preload_image_io(ImageFormat format) { encoding_module(format).preload(); }

void finish_preloads() {
  for (Module* module : {&image_module(), &exr_module(), &png_module()}) module->wait();
}

EncodeReport encode_image(const Image& image, ImageFormat format, const ByteSink& sink) {
  std::vector<RaytreePlane> planes;
  for (const ImagePlane& plane : image.planes)
    planes.push_back({plane.name.c_str(), module_type(plane.type), module_type(plane.source_type), plane.pixels});
  std::vector<RaytreeText> metadata;
  for (const auto& [name, text] : image.metadata) metadata.push_back({name.c_str(), text.c_str()});
  RaytreeImage request{};
  request.frame_width = image.frame_width;
  request.frame_height = image.frame_height;
  request.x0 = image.window.x0;
  request.y0 = image.window.y0;
  request.width = image.window.width;
  request.height = image.window.height;
  request.planes = planes.data();
  request.plane_count = planes.size();
  request.metadata = metadata.data();
  request.metadata_count = metadata.size();
  request.color_space = image.color_space.c_str();
  request.format = module_format(format);
  request.threads = static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));

  const RaytreeImageIo& io = encoding_module(format).table();
  Encoding result{sink, nullptr, {}};
  EncodeReport report;
  const auto take_piece = [](void* context, std::uint64_t offset, const void* bytes, std::size_t size) {
    auto& target = *static_cast<Encoding*>(context);
    if (target.problem) return 0;
    try {
      target.sink(offset, bytes, size);
      return 1;
    } catch (...) {
      target.problem = std::current_exception();
      return 0;
    }
  };
  const auto take_error = [](void* context, const void* bytes, std::size_t size) {
    static_cast<Encoding*>(context)->error.assign(static_cast<const char*>(bytes), size);
  };
  const bool encoded = io.encode(&request, take_piece, take_error, &result, &report.half_clamped) != 0;
  // Asked first: OpenEXR ends its files in a destructor, which reports nothing.
  if (result.problem) std::rethrow_exception(result.problem);
  if (!encoded) throw Error(ErrorKind::failure, {}, "cannot encode the picture: " + result.error);
  return report;
}

std::vector<std::byte> encode_image(const Image& image, ImageFormat format) {
  std::vector<std::byte> file;
  const auto take = [&](std::uint64_t offset, const void* bytes, std::size_t size) {
    if (file.size() < offset + size) file.resize(offset + size);
    if (size > 0) std::memcpy(file.data() + offset, bytes, size);
  };
  encode_image(image, format, take);
  return file;
}

EncodeReport write_image_file(const std::string& path, const Image& image, ImageFormat format,
                              const std::function<void()>& before_commit) {
  AtomicFile file(path);
  const EncodeReport report =
      encode_image(image, format,
                   [&](std::uint64_t offset, const void* bytes, std::size_t size) { file.write(offset, bytes, size); });
  if (before_commit) before_commit();
  file.commit();
  return report;
}

int DecodedImage::plane_index(const std::string& name) const {
  const auto found = std::find(names.begin(), names.end(), name);
  return found == names.end() ? -1 : static_cast<int>(found - names.begin());
}

DecodedImage read_image_file(const std::string& path) {
  const RaytreeImageIo& io = image_module().table();
  DecodedImage image;
  RaytreeImageSink sink{};
  sink.context = &image;
  sink.begin = [](void* context, int frame_width, int frame_height, int x0, int y0, int width, int height,
                  std::size_t plane_count) {
    auto& target = *static_cast<DecodedImage*>(context);
    target.frame_width = frame_width;
    target.frame_height = frame_height;
    target.x0 = x0;
    target.y0 = y0;
    target.width = width;
    target.height = height;
    try {
      const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
      target.names.resize(plane_count);
      target.types.resize(plane_count);
      target.id_planes.resize(plane_count);
      target.planes.assign(plane_count, std::vector<float>(pixels));
    } catch (const std::bad_alloc&) {
      return 0;
    }
    return 1;
  };
  sink.plane = [](void* context, std::size_t index, const char* name, int type) {
    auto& target = *static_cast<DecodedImage*>(context);
    target.names[index] = name;
    target.types[index] = pixel_type(type);
    if (type == kRaytreeUint32) target.id_planes[index].resize(target.planes[index].size());
  };
  sink.rows = [](void* context, int y, int rows, const void* values) {
    auto& target = *static_cast<DecodedImage*>(context);
    const std::size_t planes = target.planes.size();
    const std::size_t first = static_cast<std::size_t>(y) * static_cast<std::size_t>(target.width);
    const std::size_t count = static_cast<std::size_t>(rows) * static_cast<std::size_t>(target.width);
    const auto* source = static_cast<const char*>(values);
    for (std::size_t p = 0; p < planes; ++p)
      for (std::size_t i = 0; i < count; ++i) {
        const char* value = source + 4 * (i * planes + p);
        if (target.id_planes[p].empty()) {
          std::memcpy(&target.planes[p][first + i], value, 4);
        } else {
          std::memcpy(&target.id_planes[p][first + i], value, 4);
          target.planes[p][first + i] = static_cast<float>(target.id_planes[p][first + i]);
        }
      }
  };
  sink.metadata = [](void* context, const char* name, const char* text) {
    static_cast<DecodedImage*>(context)->metadata.emplace_back(name, text);
  };
  std::string error;
  const auto take_error = [](void* context, const void* bytes, std::size_t size) {
    static_cast<std::string*>(context)->assign(static_cast<const char*>(bytes), size);
  };
  if (io.decode(path.c_str(), &sink, take_error, &error) == 0)
    throw Error(ErrorKind::bad_input, {path, 0, ""}, "cannot read the image: " + error);
  return image;
}

}  // namespace raytree
