// Binary PLY bodies: vertices are converted in parallel at a fixed stride; faces, whose sizes vary, are walked once for
// their offsets and then converted in parallel.
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <vector>

#include "geometry/ply_body.h"

namespace raytree::ply {
namespace {

template <class T>
T load(const char* p, bool swap) {
  std::array<char, sizeof(T)> bytes;
  std::memcpy(bytes.data(), p, sizeof(T));
  if (swap) std::reverse(bytes.begin(), bytes.end());
  return std::bit_cast<T>(bytes);
}

template <class Function>
decltype(auto) with_type(Type type, Function&& function) {
  switch (type) {
    case Type::int8:
      return function(std::int8_t{});
    case Type::uint8:
      return function(std::uint8_t{});
    case Type::int16:
      return function(std::int16_t{});
    case Type::uint16:
      return function(std::uint16_t{});
    case Type::int32:
      return function(std::int32_t{});
    case Type::uint32:
      return function(std::uint32_t{});
    case Type::float32:
      return function(float{});
    case Type::float64:
      break;
  }
  return function(double{});
}

std::int64_t load_index(Type type, const char* p, bool swap) {
  return with_type(type, [&](auto zero) { return as_index(load<decltype(zero)>(p, swap)); });
}

class BinaryReader : BodyReader {
 public:
  using BodyReader::BodyReader;

  void read() {
    const char* p = header_.body.data();
    const char* const end = p + header_.body.size();
    for (const Element& element : header_.elements) {
      if (element.use == Use::faces) {
        p = read_binary_faces(p, end);
        continue;
      }
      if (element.properties.empty()) continue;
      std::vector<const char*> starts;
      const char* after = nullptr;
      if (element.has_list()) {
        starts = walk(element, p, end, nullptr, nullptr);
        after = starts.back();
      } else {
        const std::size_t stride = element.least_bytes();
        if (element.count > static_cast<std::size_t>(end - p) / stride)
          fail("the file is too short for its elements '" + element.name + "'");
        after = p + element.count * stride;
      }
      if (element.use == Use::vertices) {
        Bounds3d box;
        convert_vertices(p, starts, header_.wide ? &box : nullptr);
        mesh_.origin = mesh_origin(box);
        if (mesh_.origin != Vec3d(0, 0, 0)) convert_vertices(p, starts, nullptr);
      }
      p = after;
    }
    if (p != end) warnings_.push_back({{name_, 0, {}}, "bytes after the last element dropped", end - p});
  }

 private:
  bool swap() const { return (header_.format == Format::big_endian) != (std::endian::native == std::endian::big); }

  /// Bytes of one item at p, or 0 if it does not fit before `end` or a count is none. The list at `indices` (if
  /// wanted) comes back as its first entry and its length.
  std::size_t item_bytes(const Element& element, const char* p, const char* end, const char** list,
                         std::uint64_t* list_count) const {
    const char* const begin = p;
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
      const Property& property = element.properties[i];
      const std::size_t head = size_of(property.is_list ? property.count_type : property.type);
      if (head > static_cast<std::size_t>(end - p)) return 0;
      if (property.is_list) {
        const std::int64_t count = load_index(property.count_type, p, swap());
        const std::size_t size = size_of(property.type);
        if (count < 0 || static_cast<std::uint64_t>(count) > static_cast<std::size_t>(end - p - head) / size) return 0;
        if (list && i == element.indices) {
          *list = p + head;
          *list_count = static_cast<std::uint64_t>(count);
        }
        p += static_cast<std::size_t>(count) * size;
      }
      p += head;
    }
    return static_cast<std::size_t>(p - begin);
  }

  static constexpr std::size_t kBlock = 8192;  // elements that one task converts

  /// Where each block of kBlock items begins; the last entry is the element's end. `corner_starts`, for faces: the
  /// number of corners before each block.
  std::vector<const char*> walk(const Element& element, const char* p, const char* end,
                                std::vector<std::size_t>* corner_starts, bool* all_triangles) const {
    std::vector<const char*> starts;
    std::size_t corners = 0;
    // The usual faces, one list and nothing else, have a loop of their own.
    const bool is_simple =
        corner_starts && element.properties.size() == 1 && element.properties[0].count_type == Type::uint8;
    const std::size_t entry = is_simple ? size_of(element.properties[0].type) : 0;
    for (std::size_t item = 0; item < element.count; ++item) {
      if (item % kBlock == 0) {
        starts.push_back(p);
        if (corner_starts) corner_starts->push_back(corners);
      }
      const char* list = nullptr;
      std::uint64_t count = 0;
      std::size_t bytes = 0;
      if (is_simple && p != end) {
        count = static_cast<unsigned char>(*p);
        bytes = 1 + count * entry;
        if (bytes > static_cast<std::size_t>(end - p)) bytes = 0;
      } else {
        bytes = item_bytes(element, p, end, corner_starts ? &list : nullptr, &count);
      }
      if (bytes == 0 && !element.properties.empty())
        fail("the data end inside this element, or a list's count is no count", 0, item_name(element, item));
      if (corner_starts) {
        corners += count;
        *all_triangles = *all_triangles && count == 3;
      }
      p += bytes;
    }
    starts.push_back(p);
    if (corner_starts) corner_starts->push_back(corners);
    return starts;
  }

  /// Vertices of a fixed size are converted column by column within a block; those with lists (`starts` given) one by
  /// one. `box`, if wanted, receives the bounds of the finite positions.
  void convert_vertices(const char* begin, const std::vector<const char*>& starts, Bounds3d* box) {
    const Element& element = header_.vertices();
    const std::size_t stride = element.least_bytes();
    const std::size_t blocks = (element.count + kBlock - 1) / kBlock;
    std::vector<Bounds3d> boxes(box ? blocks : 0);
    tbb::parallel_for(std::size_t(0), blocks, [&](std::size_t block) {
      const std::size_t first = block * kBlock;
      const std::size_t last = std::min<std::size_t>(first + kBlock, element.count);
      std::array<std::vector<double>, 3> wide;  // coordinates before rounding to float, for the bounds
      if (box)
        for (std::vector<double>& column : wide) column.resize(last - first);
      const auto store = [&](const Property& property, std::size_t vertex, auto value) {
        if (box && property.role <= Role::z)
          wide[static_cast<std::size_t>(property.role) - 1][vertex - first] = static_cast<double>(value);
        *target(property.role, vertex) = static_cast<float>(static_cast<double>(value) - shift(property.role));
      };
      if (starts.empty()) {
        std::size_t offset = 0;
        for (const Property& property : element.properties) {
          const char* p = begin + first * stride + offset;
          offset += size_of(property.type);
          if (property.role == Role::none) continue;
          with_type(property.type, [&](auto zero) {
            using T = decltype(zero);
            if constexpr (std::is_same_v<T, float>) {
              if (!box && shift(property.role) == 0) {
                copy_floats(p, stride, target(property.role, first), last - first,
                            property.role == Role::u || property.role == Role::v ? 2 : 3);
                return;
              }
            }
            for (std::size_t vertex = first; vertex < last; ++vertex, p += stride)
              store(property, vertex, load<T>(p, swap()));
          });
        }
      } else {
        const char* p = starts[block];
        for (std::size_t vertex = first; vertex < last; ++vertex)
          for (const Property& property : element.properties) {
            if (property.is_list) {
              p += size_of(property.count_type) +
                   static_cast<std::size_t>(load_index(property.count_type, p, swap())) * size_of(property.type);
              continue;
            }
            if (property.role != Role::none)
              with_type(property.type, [&](auto zero) { store(property, vertex, load<decltype(zero)>(p, swap())); });
            p += size_of(property.type);
          }
      }
      if (box)
        for (std::size_t i = 0; i < last - first; ++i) extend_finite(boxes[block], wide[0][i], wide[1][i], wide[2][i]);
    });
    for (const Bounds3d& part : boxes) box->extendBy(part);
  }

  void copy_floats(const char* from, std::size_t stride, float* to, std::size_t count, std::size_t to_stride) const {
    const bool swapped = swap();
    for (std::size_t i = 0; i < count; ++i) to[i * to_stride] = load<float>(from + i * stride, swapped);
  }

  const char* read_binary_faces(const char* p, const char* end) {
    const Element& element = header_.faces();
    std::vector<std::size_t> corner_starts;
    bool all_triangles = true;
    const std::vector<const char*> starts = walk(element, p, end, &corner_starts, &all_triangles);
    allocate_faces(corner_starts.back(), all_triangles);
    const Type type = element.properties[element.indices].type;
    const std::size_t blocks = starts.size() - 1;
    std::vector<std::size_t> bad(blocks, element.count);  // first face with a bad index, per block
    const bool is_plain = all_triangles && element.properties.size() == 1 && size_of(type) == 4 &&
                          type != Type::float32 && element.properties[0].count_type == Type::uint8;
    tbb::parallel_for(std::size_t(0), blocks, [&](std::size_t block) {
      const std::size_t first = block * kBlock;
      const std::size_t last = std::min<std::size_t>(first + kBlock, element.count);
      const char* at = starts[block];
      std::uint32_t* out = mesh_.corners.data() + corner_starts[block];
      const std::size_t vertex_count = header_.vertices().count;
      if (is_plain) {
        // Read as unsigned, a negative index is 2^31 or more: out of range under this limit.
        const bool is_signed = type == Type::int32;
        const bool swapped = swap();
        const std::size_t limit = is_signed ? std::min<std::size_t>(vertex_count, std::size_t(1) << 31) : vertex_count;
        for (std::size_t face = first; face < last; ++face, at += 13, out += 3) {
          for (int i = 0; i < 3; ++i) {
            out[i] = load<std::uint32_t>(at + 1 + 4 * i, swapped);
            if (out[i] >= limit) bad[block] = std::min(bad[block], face);
          }
        }
        return;
      }
      for (std::size_t face = first; face < last; ++face) {
        const char* list = nullptr;
        std::uint64_t count = 0;
        at += item_bytes(element, at, end, &list, &count);
        with_type(type, [&](auto zero) {
          using T = decltype(zero);
          for (std::uint64_t i = 0; i < count; ++i) {
            const std::int64_t index = as_index(load<T>(list + i * sizeof(T), swap()));
            if (index < 0 || static_cast<std::uint64_t>(index) >= vertex_count) bad[block] = std::min(bad[block], face);
            *out++ = static_cast<std::uint32_t>(index);
          }
        });
        if (!all_triangles) mesh_.face_sizes[face] = static_cast<std::uint32_t>(count);
      }
    });
    for (const std::size_t face : bad)
      if (face != element.count) fail_index(face, 0);
    return starts.back();
  }
};

}  // namespace

void read_binary_body(const Header& header, std::string_view bytes, const std::string& name, Warnings& warnings,
                      PolygonMesh& mesh) {
  BinaryReader(header, bytes, name, warnings, mesh).read();
}

}  // namespace raytree::ply
