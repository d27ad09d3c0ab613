#include "benchmarks/npy_reader.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <regex>

#include "geometry/error.h"
#include "geometry/mapped_file.h"
#include "geometry/ray_batch.h"

namespace raytree::benchmarks {
namespace {

constexpr std::string_view kMagic = "\x93NUMPY";
constexpr std::size_t kMostHeader = 65536;  ///< NumPy's own are under a hundred bytes
constexpr const char* kExpected = "float32, C order, N x 6 or N x 8";

[[noreturn]] void refuse(const std::string& name, const std::string& message) {
  throw Error(ErrorKind::bad_input, {name, 0, ""}, message);
}

/// The header's dictionary, a literal of Python with three keys in any order.
struct Header {
  std::string type, order;
  std::vector<std::uint64_t> shape;
};

std::string value_of(const std::string& text, const char* key, const char* pattern, const std::string& name) {
  std::smatch match;
  if (!std::regex_search(text, match, std::regex(fmt::format("'{}'\\s*:\\s*{}", key, pattern))))
    refuse(name, fmt::format("the header has no '{}' that could be read; {} is expected", key, kExpected));
  return match[1];
}

Header parse_header(const std::string& text, const std::string& name) {
  Header header;
  header.type = value_of(text, "descr", "'([^']*)'", name);
  header.order = value_of(text, "fortran_order", "(True|False)", name);
  const std::string shape = value_of(text, "shape", "\\(([0-9, ]*)\\)", name);
  const std::regex number("[0-9]+");
  for (std::sregex_iterator at(shape.begin(), shape.end(), number), end; at != end; ++at) {
    if (at->length() > 15) refuse(name, fmt::format("shape ({}) is too large", shape));
    header.shape.push_back(std::stoull(at->str()));
  }
  if (header.type != "<f4")
    refuse(name, fmt::format("elements are \"{}\", not \"<f4\" (little-endian float32)", header.type));
  if (header.order != "False") refuse(name, "the array is in Fortran order; C order is expected");
  if (header.shape.size() != 2 || (header.shape[1] != 6 && header.shape[1] != 8))
    refuse(name, fmt::format("shape ({}) is not N x 6 or N x 8: origin, direction[, begin, end]", shape));
  if (header.shape[0] == 0) refuse(name, "it holds no rays");
  return header;
}

FileRay ray_of(const float* row, std::size_t columns, std::uint64_t index, const std::string& name) {
  const auto refuse_row = [&](const char* why) { refuse(name, fmt::format("row {}: {}", index, why)); };
  for (std::size_t i = 0; i < 6; ++i)
    if (!std::isfinite(row[i])) refuse_row(i < 3 ? "the origin is not finite" : "the direction is not finite");
  for (std::size_t i = 0; i < 3; ++i)
    if (std::abs(row[i]) > kFarthestRay) refuse_row("the origin is farther than 1e18 units away");
  const Vec3d direction(row[3], row[4], row[5]);
  // In double: the length of a direction of floats neither overflows nor vanishes.
  const double length = std::sqrt(direction.dot(direction));
  if (!(length > 0)) refuse_row("the direction is zero");
  FileRay ray;
  ray.origin = {row[0], row[1], row[2]};
  ray.direction = Vec3f(direction / length);
  ray.end = std::numeric_limits<float>::infinity();
  if (columns == 8) {
    if (!(row[6] >= 0) || !std::isfinite(row[6])) refuse_row("its begin is not 0 or a positive number");
    if (!(row[7] >= row[6])) refuse_row("its end is not a number at or behind its begin");
    ray.begin = static_cast<float>(row[6] * length);
    ray.end = static_cast<float>(row[7] * length);
    if (!(ray.begin <= kFarthestRay)) refuse_row("its begin is farther than 1e18 units away");
  }
  return ray;
}

}  // namespace

std::vector<FileRay> parse_rays(std::string_view bytes, const std::string& name) {
  static_assert(std::endian::native == std::endian::little);
  if (bytes.size() < 10 || bytes.substr(0, kMagic.size()) != kMagic)
    refuse(name, fmt::format("this is not a .npy file; {} is expected", kExpected));
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(bytes[i]); };
  const int version = byte(6);
  if (version < 1 || version > 3) refuse(name, fmt::format(".npy version {} is not known; 1 to 3 are", version));
  const std::size_t lead = version == 1 ? 10 : 12;
  if (bytes.size() < lead) refuse(name, "the file ends in its header");
  std::size_t length = byte(8) | (std::size_t(byte(9)) << 8);
  if (version > 1) length |= (std::size_t(byte(10)) << 16) | (std::size_t(byte(11)) << 24);
  if (length > kMostHeader || bytes.size() < lead + length) refuse(name, "the file ends in its header");
  const Header header = parse_header(std::string(bytes.substr(lead, length)), name);
  const std::uint64_t rows = header.shape[0], columns = header.shape[1];
  const std::string_view data = bytes.substr(lead + length);
  if (data.size() / (4 * columns) != rows || data.size() % (4 * columns) != 0)
    refuse(name, fmt::format("{} rays of {} numbers take {} bytes, the file has {}", rows, columns, rows * columns * 4,
                             data.size()));
  std::vector<FileRay> rays;
  rays.reserve(rows);
  float row[8];
  for (std::uint64_t i = 0; i < rows; ++i) {
    std::memcpy(row, data.data() + i * columns * 4, columns * 4);
    rays.push_back(ray_of(row, columns, i, name));
  }
  return rays;
}

std::vector<FileRay> read_rays(const std::string& path) {
  const MappedFile file(path);
  return parse_rays(file.bytes(), path);
}

}  // namespace raytree::benchmarks
