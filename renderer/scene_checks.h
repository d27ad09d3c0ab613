// What the tables of scene_fields.h cannot say: conditions on several values at once, and transforms.
#pragma once

#include <cstdint>

#include "renderer/scene_fields.h"
#include "renderer/scene_place.h"

namespace raytree::reading {

/// Throw Error (bad_input) at the place and line when the object as a whole cannot be; most can.
void check(const Place&, std::int64_t, const auto&) {}
void check(const Place& at, std::int64_t line, const ImageDescription& image);
void check(const Place& at, std::int64_t line, const CameraDescription& camera);
void check(const Place& at, std::int64_t line, const MaterialDescription& material);

void check(const Place& at, std::int64_t line, const ShapeDescription& shape);

/// Materials, groups and terrains that shapes name must exist, and no group may hold itself.
void check_references(const Place& root, const SceneDescription& scene);

/// For row vectors: p * result. Scale, then rotation about x, y and z, then translation; exact at multiples of 90
/// degrees.
Matrix44d matrix_of(const TransformStep& step);

/// Whether the inverse can be formed with some digits left; lengths of the axes do not matter.
bool invertible(const Matrix44d& m);

template <class T>
std::vector<std::string> names_of(const std::vector<T>& elements) {
  std::vector<std::string> names;
  for (const T& element : elements) names.push_back(element.name);
  return names;
}

}  // namespace raytree::reading
