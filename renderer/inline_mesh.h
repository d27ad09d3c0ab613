// Polygon meshes as scene files give them, to PolygonMesh and back: index checks, and the choice of an origin that
// keeps far positions exact.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "renderer/scene_fields.h"

namespace raytree {

/// Makes the mesh. What is wrong is told to `refuse(key, index, line, message)`, which must throw: `key` names the
/// list, `index` its element (-1: the list as a whole), `line` where a face stands (0: unknown). Without an origin
/// given, each axis gets the middle of the positions' range as origin where they lie farther from 0 than twice that
/// range, and 0 elsewhere.
std::shared_ptr<PolygonMesh> polygon_mesh(
    const InlineMesh& lists, const std::function<void(const std::string& key, std::int64_t index, std::int64_t line,
                                                      const std::string& message)>& refuse);

/// The lists of a mesh, its origin always given, so that polygon_mesh(inline_mesh(m)) equals m.
InlineMesh inline_mesh(const PolygonMesh& mesh);

}  // namespace raytree
