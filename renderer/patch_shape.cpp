#include "renderer/patch_shape.h"

#include <algorithm>
#include <filesystem>

#include "geometry/patch_reader.h"
#include "geometry/surface_of_revolution.h"

namespace raytree {
namespace {

/// Control points by index, checked: a description need not come from a file.
class ControlPoints {
 public:
  ControlPoints(const PatchesShape& shape, const SourceLocation& where) : shape_(shape), where_(where) {
    if (!shape.weights.empty() && shape.weights.size() != shape.positions.size())
      throw Error(ErrorKind::bad_input, where, "patches need as many weights as positions, or none");
  }

  BezierPatch patch(const std::array<std::uint32_t, 16>& indices) const {
    BezierPatch result;
    for (std::size_t i = 0; i < 16; ++i) result.points[i] = point(indices[i]), result.weights[i] = weight(indices[i]);
    return result;
  }
  BezierCurve curve(const std::array<std::uint32_t, 4>& indices) const {
    BezierCurve result;
    for (std::size_t i = 0; i < 4; ++i) result.points[i] = point(indices[i]), result.weights[i] = weight(indices[i]);
    return result;
  }

 private:
  const Vec3d& point(std::uint32_t index) const {
    if (index >= shape_.positions.size())
      throw Error(ErrorKind::bad_input, where_,
                  "index " + std::to_string(index) + " of a control point is out of range: there are " +
                      std::to_string(shape_.positions.size()) + ", counted from 0");
    return shape_.positions[index];
  }
  double weight(std::uint32_t index) const { return shape_.weights.empty() ? 1 : shape_.weights[index]; }

  const PatchesShape& shape_;
  const SourceLocation& where_;
};

std::vector<BezierPatch> read_file(const std::string& file, const std::string& folder, const SourceLocation& where,
                                   Warnings& warnings) {
  const std::filesystem::path path = std::filesystem::path(folder) / file;
  if (!is_patch_file_name(file)) throw Error(ErrorKind::bad_input, where, "patches are read from .bpt files");
  try {
    return read_patch_file(path.string(), warnings);
  } catch (const Error& error) {
    if (where.file.empty()) throw;
    // A file that cannot be had is the scene's mistake; of one that is damaged the scene's place comes second.
    if (std::filesystem::exists(path)) throw named_by(error, where);
    throw Error(error.kind(), where, error.what());
  }
}

}  // namespace

std::vector<SurfacePatch> surface_patches(const PatchesShape& shape, const std::string& folder,
                                          const SourceLocation& where, Warnings& warnings) {
  std::vector<SurfacePatch> patches;
  if (!shape.file.empty()) {
    const std::vector<BezierPatch> read = read_file(shape.file, folder, where, warnings);
    patches.assign(read.begin(), read.end());
    return patches;
  }
  const ControlPoints control(shape, where);
  for (const auto& indices : shape.bezier) patches.emplace_back(control.patch(indices));
  for (const auto& i : shape.coons)
    // Once around: along u, along v, and both backwards.
    patches.emplace_back(CoonsPatch{control.curve({i[0], i[1], i[2], i[3]}), control.curve({i[9], i[8], i[7], i[6]}),
                                    control.curve({i[0], i[11], i[10], i[9]}),
                                    control.curve({i[3], i[4], i[5], i[6]})});
  std::vector<BezierCurve> profile;
  for (const auto& indices : shape.lathe) profile.push_back(control.curve(indices));
  for (const BezierPatch& patch : revolve(profile)) patches.emplace_back(patch);
  return patches;
}

PatchSurfaceOptions surface_options(const PatchesShape& shape) {
  return {shape.crease_angle, shape.flip, shape.degenerate_normals};
}

}  // namespace raytree
