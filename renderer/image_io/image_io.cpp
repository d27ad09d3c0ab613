// The module that links OpenImageIO, its only use in Raytree: encodes planes to a JPEG or TIFF file in memory and
// decodes files of any format. It never touches the disk when it writes: through OpenImageIO 2.4 a full disk goes
// unnoticed or hangs.

#include <Imath/half.h>
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "renderer/image_io/module_calls.h"
#include "renderer/image_io/pixel_rows.h"

namespace {

using namespace raytree::image_io;

constexpr int kLargestSide = 1 << 20;
constexpr int kMostPlanes = 1024;
// A file whose header promises far more than its bytes can hold is refused before memory is asked for: deflate
// reaches 1032:1, run lengths less.
constexpr std::uint64_t kBombBytes = std::uint64_t{256} << 20;
constexpr std::uint64_t kBombRatio = 2048;
constexpr std::uint64_t kMostBytes = std::uint64_t{16} << 30;

// First line of the description that carries the metadata in formats without named text fields.
constexpr std::string_view kDescriptionHead = "raytree metadata\n";

[[noreturn]] void fail(const std::string& message) { throw std::runtime_error(message); }

OIIO::TypeDesc oiio_type(int type) {
  switch (type) {
    case kRaytreeUint8:
      return OIIO::TypeDesc::UINT8;
    case kRaytreeUint16:
      return OIIO::TypeDesc::UINT16;
    case kRaytreeHalf:
      return OIIO::TypeDesc::HALF;
    case kRaytreeFloat32:
      return OIIO::TypeDesc::FLOAT;
    case kRaytreeUint32:
      return OIIO::TypeDesc::UINT32;
    default:
      fail("unknown pixel type");
  }
}

std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c == '\\')
      result += "\\\\";
    else if (c == '\n')
      result += "\\n";
    else
      result += c;
  }
  return result;
}

std::string unescaped(std::string_view text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\\' && i + 1 < text.size())
      result += text[++i] == 'n' ? '\n' : text[i];
    else
      result += text[i];
  }
  return result;
}

void add_metadata(OIIO::ImageSpec& spec, const RaytreeImage& image) {
  // TIFF and JPEG have no fields of free name: all of it goes into the description, one "name: text" a line.
  if (image.format == kRaytreeTiff || image.format == kRaytreeJpeg) {
    if (image.metadata_count == 0) return;
    std::string description(kDescriptionHead);
    for (std::size_t i = 0; i < image.metadata_count; ++i)
      description += std::string(image.metadata[i].name) + ": " + escaped(image.metadata[i].text) + "\n";
    spec.attribute("ImageDescription", description);
    return;
  }
  for (std::size_t i = 0; i < image.metadata_count; ++i)
    spec.attribute(image.metadata[i].name, std::string(image.metadata[i].text));
}

OIIO::ImageSpec spec_of(const RaytreeImage& image) {
  const int channels = static_cast<int>(image.plane_count);
  bool same_type = true;
  for (std::size_t i = 1; i < image.plane_count; ++i)
    same_type = same_type && image.planes[i].type == image.planes[0].type;
  OIIO::ImageSpec spec(image.width, image.height, channels, oiio_type(image.planes[0].type));
  spec.channelnames.clear();
  for (std::size_t i = 0; i < image.plane_count; ++i) {
    spec.channelnames.emplace_back(image.planes[i].name);
    if (spec.channelnames.back() == "A") spec.alpha_channel = static_cast<int>(i);
  }
  if (!same_type) fail("all channels of this format must have one type");
  // What the picture shows is not divided by its coverage, on the way in nor out.
  spec.attribute("oiio:UnassociatedAlpha", 1);
  switch (image.format) {
    case kRaytreeJpeg:
      if (image.planes[0].type != kRaytreeUint8) fail("JPEG holds 8 bits");
      if (channels != 1 && channels != 3) fail("JPEG holds 1 or 3 channels, no alpha");
      spec.attribute("Compression", "jpeg:95");
      spec.attribute("jpeg:subsampling", "4:4:4");
      break;
    case kRaytreeTiff:
      if (image.planes[0].type == kRaytreeHalf) fail("TIFF holds 8 or 16 bits, float32 or uint32");
      spec.attribute("compression", "zip");
      // Its Exif directory cannot be written in memory; nothing of ours would stand in it.
      spec.attribute("tiff:write_exif", 0);
      break;
    default:
      break;
  }
  if (std::string_view(image.color_space) == "srgb") spec.attribute("oiio:ColorSpace", "sRGB");
  if (std::string_view(image.color_space) == "linear_rec709") spec.attribute("oiio:ColorSpace", "Linear");
  spec.attribute("Software", "raytree");
  // Absent, OpenImageIO puts in the time of day, and equal pictures would be unequal files.
  spec.attribute("DateTime", "");
  add_metadata(spec, image);
  return spec;
}

const char* dummy_name(int format) {
  switch (format) {
    case kRaytreeJpeg:
      return "a.jpg";
    case kRaytreeTiff:
      return "a.tif";
    default:
      fail("this module encodes JPEG and TIFF");
  }
}

// A file in memory that can be read back while it is written: the TIFF writer reads its own directory, which
// OpenImageIO's IOVecOutput does not offer.
class MemoryFile : public OIIO::Filesystem::IOProxy {
 public:
  MemoryFile() : IOProxy("", Write) {}
  const char* proxytype() const override { return "memoryfile"; }
  std::size_t read(void* buffer, std::size_t size) override { return advanced(pread(buffer, size, m_pos)); }
  std::size_t write(const void* buffer, std::size_t size) override { return advanced(pwrite(buffer, size, m_pos)); }
  std::size_t pread(void* buffer, std::size_t size, std::int64_t offset) override {
    const std::lock_guard lock(mutex_);
    const auto begin = static_cast<std::size_t>(offset);
    if (offset < 0 || begin >= bytes_.size()) return 0;
    const std::size_t count = std::min(size, bytes_.size() - begin);
    std::memcpy(buffer, bytes_.data() + begin, count);
    return count;
  }
  std::size_t pwrite(const void* buffer, std::size_t size, std::int64_t offset) override {
    const std::lock_guard lock(mutex_);
    if (offset < 0) return 0;
    const auto begin = static_cast<std::size_t>(offset);
    if (size == 0) return 0;
    if (bytes_.size() < begin + size) bytes_.resize(begin + size);
    std::memcpy(bytes_.data() + begin, buffer, size);
    return size;
  }
  std::size_t size() const override { return bytes_.size(); }
  const std::vector<std::byte>& bytes() const { return bytes_; }

 private:
  std::size_t advanced(std::size_t count) {
    m_pos += static_cast<std::int64_t>(count);
    return count;
  }

  std::mutex mutex_;
  std::vector<std::byte> bytes_;
};

void encode_to(MemoryFile& file, const RaytreeImage& image) {
  if (image.plane_count == 0 || image.width <= 0 || image.height <= 0) fail("a picture without pixels");
  // First, since OpenImageIO's JPEG writer crashes when it goes away without having been opened.
  const OIIO::ImageSpec spec = spec_of(image);
  const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(dummy_name(image.format));
  if (!output) fail("no writer of this format: " + OIIO::geterror());
  if (!output->supports("ioproxy") || !output->set_ioproxy(&file)) fail("this format cannot be encoded in memory");
  output->threads(image.threads);
  const auto check = [&](bool done) {
    if (done && !output->has_error()) return;
    std::string reason = output->geterror();
    if (reason.empty()) reason = "the encoder failed without a reason";
    fail(reason);
  };
  check(output->open(dummy_name(image.format), spec));

  std::size_t stride = 0;
  std::vector<std::size_t> offsets;
  for (std::size_t i = 0; i < image.plane_count; ++i) {
    offsets.push_back(stride);
    stride += pixel_size(image.planes[i].type);
  }
  const auto width = static_cast<std::size_t>(image.width);
  // Enough rows at once for every thread to compress blocks of 16 rows, and little memory.
  constexpr int kRowsAtOnce = 256;
  std::vector<std::byte> rows(stride * width * static_cast<std::size_t>(std::min(image.height, kRowsAtOnce)));
  for (int y = 0; y < image.height; y += kRowsAtOnce) {
    const int count = std::min(kRowsAtOnce, image.height - y);
    for (std::size_t i = 0; i < image.plane_count; ++i)
      convert_row(image.planes[i], static_cast<std::size_t>(y) * width, static_cast<std::size_t>(count) * width,
                  rows.data() + offsets[i], stride);
    check(output->write_scanlines(spec.y + y, spec.y + y + count, 0, OIIO::TypeDesc::UNKNOWN, rows.data()));
  }
  check(output->close());
  if (file.bytes().empty()) fail("the encoder wrote nothing");
}

int plane_type(OIIO::TypeDesc type) {
  if (type == OIIO::TypeDesc::UINT8) return kRaytreeUint8;
  if (type == OIIO::TypeDesc::UINT16) return kRaytreeUint16;
  if (type == OIIO::TypeDesc::HALF) return kRaytreeHalf;
  if (type == OIIO::TypeDesc::FLOAT) return kRaytreeFloat32;
  if (type == OIIO::TypeDesc::UINT32) return kRaytreeUint32;
  return kRaytreeOther;
}

void hand_over_metadata(const OIIO::ImageSpec& spec, const RaytreeImageSink& sink) {
  for (const OIIO::ParamValue& value : spec.extra_attribs) {
    if (value.type() != OIIO::TypeDesc::STRING) continue;
    const std::string text = value.get_string();
    if (value.name() == "ImageDescription" && text.starts_with(kDescriptionHead)) {
      std::string_view rest = std::string_view(text).substr(kDescriptionHead.size());
      while (!rest.empty()) {
        const std::size_t end = std::min(rest.find('\n'), rest.size());
        const std::string_view line = rest.substr(0, end);
        rest.remove_prefix(std::min(end + 1, rest.size()));
        if (const std::size_t colon = line.find(": "); colon != std::string_view::npos)
          sink.metadata(sink.context, std::string(line.substr(0, colon)).c_str(),
                        unescaped(line.substr(colon + 2)).c_str());
      }
      continue;
    }
    sink.metadata(sink.context, value.name().c_str(), text.c_str());
  }
}

void decode_file(const char* path, const RaytreeImageSink& sink) {
  std::error_code problem;
  if (!std::filesystem::is_regular_file(path, problem))
    fail(problem ? problem.message() : std::string("not a regular file"));
  const std::uint64_t file_bytes = std::filesystem::file_size(path, problem);
  OIIO::ImageSpec config;
  config.attribute("oiio:UnassociatedAlpha", 1);
  const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(path, &config);
  if (!input) {
    const std::string reason = OIIO::geterror();
    fail(reason.empty() ? "not a readable image" : reason);
  }
  const OIIO::ImageSpec spec = input->spec();
  if (spec.deep) fail("deep images are not read");
  if (spec.depth > 1) fail("volumes are not read");
  if (spec.width <= 0 || spec.height <= 0 || spec.nchannels <= 0 || spec.width > kLargestSide ||
      spec.height > kLargestSide || spec.nchannels > kMostPlanes)
    fail("the header's size is out of range");
  const auto planes = static_cast<std::size_t>(spec.nchannels);
  const std::uint64_t bytes = static_cast<std::uint64_t>(spec.width) * static_cast<std::uint64_t>(spec.height) *
                              static_cast<std::uint64_t>(planes) * 4;
  if (bytes > kMostBytes || (bytes > kBombBytes && bytes / kBombRatio > file_bytes))
    fail("the header promises " + std::to_string(bytes >> 20) + " MiB of pixels, which " + std::to_string(file_bytes) +
         " bytes of file cannot hold");
  if (sink.begin(sink.context, spec.full_width, spec.full_height, spec.x - spec.full_x, spec.y - spec.full_y,
                 spec.width, spec.height, planes) == 0)
    fail("not enough memory for the picture");
  bool native = true;
  std::vector<int> types;
  for (std::size_t i = 0; i < planes; ++i) {
    const int type = plane_type(spec.channelformat(static_cast<int>(i)));
    types.push_back(type);
    sink.plane(sink.context, i, spec.channel_name(static_cast<int>(i)).c_str(), type);
    native = native && type != kRaytreeOther;
  }
  hand_over_metadata(spec, sink);

  const auto check = [&](bool done) {
    if (done && !input->has_error()) return;
    std::string reason = input->geterror();
    if (reason.empty()) reason = "the decoder failed without a reason";
    fail(reason);
  };
  // Pixels come in the file's own types, since a conversion to float would lose ids above 2^24.
  std::size_t stride = 0;
  std::vector<std::size_t> offsets;
  for (std::size_t i = 0; i < planes; ++i) {
    offsets.push_back(stride);
    stride += native ? pixel_size(types[i]) : 4;
  }
  const auto width = static_cast<std::size_t>(spec.width);
  const auto pixels = width * static_cast<std::size_t>(spec.height);
  std::vector<std::byte> raw(pixels * stride);
  check(
      input->read_image(0, 0, 0, spec.nchannels, native ? OIIO::TypeDesc::UNKNOWN : OIIO::TypeDesc::FLOAT, raw.data()));
  std::vector<std::uint32_t> row(width * planes);
  for (int y = 0; y < spec.height; ++y) {
    const std::byte* source = raw.data() + static_cast<std::size_t>(y) * width * stride;
    for (std::size_t i = 0; i < planes; ++i) {
      const int type = native ? types[i] : kRaytreeFloat32;
      for (std::size_t x = 0; x < width; ++x) {
        const std::byte* value = source + x * stride + offsets[i];
        std::uint32_t* target = &row[x * planes + i];
        float level = 0;
        if (type == kRaytreeFloat32 || type == kRaytreeUint32) {
          std::memcpy(target, value, 4);
          continue;
        }
        if (type == kRaytreeUint8) {
          level = static_cast<float>(std::to_integer<int>(*value)) / 255.0f;
        } else {
          std::uint16_t bits = 0;
          std::memcpy(&bits, value, 2);
          if (type == kRaytreeHalf) {
            Imath::half half;
            half.setBits(bits);
            level = half;
          } else {
            level = static_cast<float>(bits) / 65535.0f;
          }
        }
        std::memcpy(target, &level, 4);
      }
    }
    sink.rows(sink.context, y, 1, row.data());
  }
}

int encode(const RaytreeImage* image, RaytreeFileSink file, RaytreeBytesSink error, void* context, std::int64_t*) {
  return guarded(
      [&] {
        MemoryFile whole;
        encode_to(whole, *image);
        hand_over(file, context, 0, whole.bytes().data(), whole.bytes().size());
      },
      error, context);
}

int decode(const char* path, const RaytreeImageSink* sink, RaytreeBytesSink error, void* error_context) {
  return guarded([&] { decode_file(path, *sink); }, error, error_context);
}

}  // namespace

extern "C" __attribute__((visibility("default"))) const RaytreeImageIo* raytree_image_io() {
  static const RaytreeImageIo table = {kRaytreeImageIoVersion, encode, decode};
  return &table;
}
