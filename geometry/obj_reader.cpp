// The OBJ reader: one parallel pass counts, so that every array is allocated once at its final size, and a second one
// parses into place. What a chunk of the text finds is kept per chunk and joined in file order, so results, warnings
// and the error reported never depend on threads.
#include "geometry/obj_reader.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/mesh_checks.h"
#include "geometry/obj_counts.h"
#include "geometry/obj_statements.h"
#include "geometry/obj_tags.h"
#include "geometry/obj_values.h"
#include "geometry/text_scanning.h"

namespace raytree {
namespace {

using namespace text;

/// The names in force from a face on; the names are places in the text, empty where the chunk has not set them.
struct GroupChange {
  std::size_t face;
  const char* name;
  const char* material;
};

struct Findings {
  const char* error_place = nullptr;
  std::string error;
  ObjTally extra_components, unknown, line_or_point, free_form, libraries_dropped;
  ObjTagFindings tags;
  Bounds3d box;
  std::vector<GroupChange> changes;
  std::vector<const char*> libraries;
  const char* last_name = nullptr;
  const char* last_material = nullptr;
};

/// Of one mesh; exporters write one or a few.
constexpr std::size_t kMaxLibraries = 256;

class ObjParser {
 public:
  ObjParser(std::string_view text, const std::string& name, Warnings& warnings)
      : text_(text), name_(name), warnings_(warnings) {}

  PolygonMesh parse() {
    check_encoding();
    borders_ = chunk_borders(text_, newline_);
    const std::size_t chunk_count = borders_.size() - 1;
    starts_.resize(chunk_count + 1);
    tbb::parallel_for(std::size_t(0), chunk_count,
                      [&](std::size_t i) { starts_[i + 1] = count_obj(borders_[i], borders_[i + 1], newline_); });
    for (std::size_t i = 0; i < chunk_count; ++i) {
      ObjCounts sum = starts_[i];
      sum.add(starts_[i + 1]);
      starts_[i + 1] = sum;
    }
    totals_ = starts_.back();
    allocate();
    findings_.resize(chunk_count);
    tbb::parallel_for(std::size_t(0), chunk_count, [&](std::size_t i) { parse_chunk(i); });
    report_first_error();
    move_origin();
    join_groups();
    join_libraries();
    join_tags();
    join_warnings();
    const MeshLocator locate{[this](std::size_t i) { return locate_statement(ObjStatement::position, i); },
                             [this](std::size_t i) { return locate_statement(ObjStatement::face, i); }};
    findings_ = {};
    complete_corners(mesh_, locate, warnings_);
    settle_mesh(mesh_, name_, locate, warnings_);
    return std::move(mesh_);
  }

 private:
  void check_encoding() {
    if (text_.substr(0, 3) == "\xef\xbb\xbf") text_.remove_prefix(3);
    if (text_.substr(0, 2) == "\xff\xfe" || text_.substr(0, 2) == "\xfe\xff")
      throw Error(ErrorKind::bad_input, {name_, 1, {}}, "the file is UTF-16 text: save it as UTF-8");
    // Files of old Macintosh programs end their lines with a carriage return alone.
    if (text_.find('\n') == std::string_view::npos && text_.find('\r') != std::string_view::npos) newline_ = '\r';
  }

  void allocate() {
    for (const std::size_t count : {totals_.positions, totals_.normals, totals_.texture_coordinates, totals_.corners})
      if (count >= kNoIndex)
        throw Error(ErrorKind::bad_input, {name_, 0, {}}, "more than 4294967294 vertices or corners in one mesh");
    mesh_.positions.resize(totals_.positions);
    mesh_.corners.resize(totals_.corners);
    if (!totals_.all_triangles) mesh_.face_sizes.resize(totals_.faces);
    if (totals_.names_normals) {
      mesh_.normals.resize(totals_.normals);
      mesh_.normal_corners.resize(totals_.corners);
    }
    if (totals_.names_texture) {
      mesh_.texture_coordinates.resize(totals_.texture_coordinates);
      mesh_.texture_corners.resize(totals_.corners);
    }
  }

  bool parse_face(const char* p, const char* end, ObjCounts& at, std::string& error) {
    const std::size_t first = at.corners;
    for (;;) {
      p = skip_blanks(p, end);
      if (p == end || *p == '#') break;
      const char* const corner = p;
      std::uint32_t texture = kNoIndex, normal = kNoIndex;
      p = scan_obj_index(p, end, at.positions, totals_.positions, "vertex", mesh_.corners[at.corners], error);
      if (!p) return false;
      const auto corner_ends = [&] { return p == end || is_blank(*p) || *p == '#'; };
      if (p != end && *p == '/') {
        ++p;
        if (!corner_ends() && *p != '/')
          p = scan_obj_index(p, end, at.texture_coordinates, totals_.texture_coordinates, "texture coordinates",
                             texture, error);
        if (!p) return false;
        if (p != end && *p == '/') {
          ++p;
          if (!corner_ends()) p = scan_obj_index(p, end, at.normals, totals_.normals, "normal", normal, error);
          if (!p) return false;
        }
      }
      if (!corner_ends()) {
        error = in_quotes(word_at(corner, end)) + " is not a corner of a face";
        return false;
      }
      if (totals_.names_texture) mesh_.texture_corners[at.corners] = texture;
      if (totals_.names_normals) mesh_.normal_corners[at.corners] = normal;
      ++at.corners;
    }
    if (!totals_.all_triangles) mesh_.face_sizes[at.faces] = static_cast<std::uint32_t>(at.corners - first);
    ++at.faces;
    return true;
  }

  bool parse_position(const char* p, const char* end, Vec3f& position, Findings& found, const char* source) {
    double v[3];
    p = scan_obj_numbers(p, end, v, 3, 3, found.error);
    if (!p) return false;
    position = Vec3f(static_cast<float>(v[0] - mesh_.origin.x), static_cast<float>(v[1] - mesh_.origin.y),
                     static_cast<float>(v[2] - mesh_.origin.z));
    constexpr double kMax = std::numeric_limits<double>::max();
    if (std::abs(v[0]) <= kMax && std::abs(v[1]) <= kMax && std::abs(v[2]) <= kMax)
      found.box.extendBy(Vec3d(v[0], v[1], v[2]));
    p = skip_blanks(p, end);
    if (p != end && *p != '#') found.extra_components.add(source);
    return true;
  }

  bool parse_tag(const char* p, const char* end, Findings& found, const char* source) const {
    return scan_obj_tag(p, end, {totals_.positions, totals_.faces}, source, found.tags, found.error);
  }

  void parse_chunk(std::size_t chunk) {
    Findings& found = findings_[chunk];
    ObjCounts at = starts_[chunk];
    bool names_changed = false;
    for_each_obj_statement(borders_[chunk], borders_[chunk + 1], newline_,
                           [&](ObjStatement kind, const char* p, const char* end, const char* source) {
                             bool good = true;
                             switch (kind) {
                               case ObjStatement::position:
                                 good = parse_position(p, end, mesh_.positions[at.positions++], found, source);
                                 break;
                               case ObjStatement::normal:
                                 if (totals_.names_normals) {
                                   double v[3];
                                   good = scan_obj_numbers(p, end, v, 3, 3, found.error) != nullptr;
                                   if (good)
                                     mesh_.normals[at.normals] = Vec3f(
                                         static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2]));
                                 }
                                 ++at.normals;
                                 break;
                               case ObjStatement::texture_coordinates:
                                 if (totals_.names_texture) {
                                   double v[2] = {0, 0};
                                   good = scan_obj_numbers(p, end, v, 2, 1, found.error) != nullptr;
                                   if (good)
                                     mesh_.texture_coordinates[at.texture_coordinates] =
                                         Vec2f(static_cast<float>(v[0]), static_cast<float>(v[1]));
                                 }
                                 ++at.texture_coordinates;
                                 break;
                               case ObjStatement::face:
                                 if (names_changed)
                                   found.changes.push_back({at.faces, found.last_name, found.last_material});
                                 names_changed = false;
                                 good = parse_face(p, end, at, found.error);
                                 break;
                               case ObjStatement::group:
                                 found.last_name = source;
                                 names_changed = true;
                                 break;
                               case ObjStatement::material:
                                 found.last_material = source;
                                 names_changed = true;
                                 break;
                               case ObjStatement::library:
                                 if (found.libraries.size() < 16 * kMaxLibraries)  // names may repeat
                                   found.libraries.push_back(source);
                                 else
                                   found.libraries_dropped.add(source);
                                 break;
                               case ObjStatement::subdivision_tag:
                                 good = parse_tag(p, end, found, source);
                                 break;
                               case ObjStatement::line_or_point:
                                 found.line_or_point.add(source);
                                 break;
                               case ObjStatement::free_form:
                                 found.free_form.add(source);
                                 break;
                               case ObjStatement::unknown:
                                 found.unknown.add(source);
                                 break;
                               case ObjStatement::silent:
                               case ObjStatement::none:
                                 break;
                             }
                             if (!good) found.error_place = source;
                             return good;
                           });
  }

  void report_first_error() const {
    for (const Findings& found : findings_)
      if (found.error_place) throw Error(ErrorKind::bad_input, location(found.error_place), found.error);
  }

  /// Positions were parsed about zero; where the rule asks for another origin they are parsed once more.
  void move_origin() {
    Bounds3d box;
    for (const Findings& found : findings_) box.extendBy(found.box);
    mesh_.origin = mesh_origin(box);
    if (mesh_.origin == Vec3d(0, 0, 0)) return;
    tbb::parallel_for(std::size_t(0), findings_.size(), [&](std::size_t chunk) {
      std::size_t position = starts_[chunk].positions;
      Findings ignored;
      for_each_obj_statement(borders_[chunk], borders_[chunk + 1], newline_,
                             [&](ObjStatement kind, const char* p, const char* end, const char* source) {
                               return kind != ObjStatement::position ||
                                      parse_position(p, end, mesh_.positions[position++], ignored, source);
                             });
    });
  }

  /// What follows the first word of the statement at `source`, blanks trimmed, at most kMaxName bytes: every run of
  /// faces holds a copy, so that a long name could multiply a file's size.
  std::string name_at(const char* source) const {
    constexpr std::ptrdiff_t kMaxName = 255;
    std::string result;
    if (!source) return result;
    for_each_obj_statement(source, text_.data() + text_.size(), newline_,
                           [&](ObjStatement, const char* p, const char* end, const char*) {
                             p = skip_blanks(p, end);
                             while (end > p && is_blank(end[-1])) --end;
                             result.assign(p, std::min(end - p, kMaxName) + p);
                             return false;
                           });
    return result;
  }

  void join_groups() {
    // A run costs far more memory than the two short lines it may come from: beyond this many they are joined.
    constexpr std::size_t kMaxGroups = std::size_t(1) << 18;
    const char* name = nullptr;
    const char* material = nullptr;
    std::size_t dropped_from = 0;
    const char* place = nullptr;
    std::int64_t dropped = 0;
    for (std::size_t chunk = 0; chunk < findings_.size(); ++chunk) {
      Findings& found = findings_[chunk];
      // Names set at the end of an earlier chunk, after its last face, hold from this chunk's first face on.
      std::vector<GroupChange> changes = std::move(found.changes);
      if (starts_[chunk + 1].faces > starts_[chunk].faces &&
          (changes.empty() || changes.front().face != starts_[chunk].faces))
        changes.insert(changes.begin(), {starts_[chunk].faces, nullptr, nullptr});
      for (const GroupChange& change : changes) {
        const char* const new_name = change.name ? change.name : name;
        const char* const new_material = change.material ? change.material : material;
        FaceGroup group{name_at(new_name), name_at(new_material), static_cast<std::uint32_t>(change.face), 0};
        if (!mesh_.groups.empty() && mesh_.groups.back().name == group.name &&
            mesh_.groups.back().material == group.material)
          continue;
        if (mesh_.groups.size() >= kMaxGroups) {
          if (dropped++ == 0) {
            dropped_from = change.face;
            place = change.name ? change.name : change.material;
          }
          continue;
        }
        mesh_.groups.push_back(std::move(group));
      }
      if (found.last_name) name = found.last_name;
      if (found.last_material) material = found.last_material;
    }
    if (dropped > 0)
      warnings_.push_back(
          {location(place ? place : text_.data()),
           "groups beyond the first 262144 joined into one, from face " + std::to_string(dropped_from + 1) + " on",
           dropped});
    std::vector<FaceGroup>& groups = mesh_.groups;
    for (std::size_t i = 0; i < groups.size(); ++i)
      groups[i].face_count = static_cast<std::uint32_t>(
          (i + 1 < groups.size() ? groups[i + 1].first_face : totals_.faces) - groups[i].first_face);
    if (groups.size() == 1 && groups[0].name.empty() && groups[0].material.empty()) groups.clear();
  }

  void join_libraries() {
    for (Findings& found : findings_)
      for (const char* const place : found.libraries) {
        std::string library = name_at(place);
        std::vector<std::string>& known = mesh_.material_libraries;
        if (std::find(known.begin(), known.end(), library) != known.end()) continue;
        if (known.size() < kMaxLibraries)
          known.push_back(std::move(library));
        else
          found.libraries_dropped.add(place);
      }
  }

  void join_tags() {
    SubdivisionRules rules;
    bool any = false;
    for (const Findings& found : findings_) {
      if (!found.tags.any) continue;
      rules = joined(std::move(rules), found.tags.rules);
      any = true;
    }
    if (any) mesh_.subdivision = std::move(rules);
  }

  void join_warnings() {
    Findings all;
    for (const Findings& found : findings_) {
      all.extra_components.add(found.extra_components);
      all.unknown.add(found.unknown);
      all.line_or_point.add(found.line_or_point);
      all.free_form.add(found.free_form);
      all.libraries_dropped.add(found.libraries_dropped);
      all.tags.edits.add(found.tags.edits);
      all.tags.unknown.add(found.tags.unknown);
    }
    const auto warn = [&](const ObjTally& tally, const std::string& message) {
      if (tally.count > 0) warnings_.push_back({location(tally.first), message, tally.count});
    };
    const char* const end = text_.data() + text_.size();
    if (all.unknown.count > 0)
      warn(all.unknown,
           "unknown statements skipped, the first is " + in_quotes(word_at(skip_blanks(all.unknown.first, end), end)));
    warn(all.line_or_point, "lines and points dropped: only faces are drawn");
    warn(all.free_form, "statements of free-form curves and surfaces dropped");
    warn(all.libraries_dropped, "material libraries beyond the first 256 not read");
    warn(all.tags.edits, "hierarchical edits of subdivision surfaces ignored");
    warn(all.tags.unknown, "subdivision tags of unknown names ignored");
    warn(all.extra_components,
         "vertices with more than three components, of which the others (weight or color) are "
         "dropped");
    if (!totals_.names_normals && totals_.normals > 0)
      warnings_.push_back({locate_statement(ObjStatement::normal, 0), "normals that no face uses dropped",
                           static_cast<std::int64_t>(totals_.normals)});
    if (!totals_.names_texture && totals_.texture_coordinates > 0)
      warnings_.push_back({locate_statement(ObjStatement::texture_coordinates, 0),
                           "texture coordinates that no face uses dropped",
                           static_cast<std::int64_t>(totals_.texture_coordinates)});
  }

  SourceLocation location(const char* place) const { return {name_, line_number(text_, place, newline_), {}}; }

  SourceLocation locate_statement(ObjStatement wanted, std::size_t number) const {
    SourceLocation result{name_, 0, {}};
    for_each_obj_statement(text_.data(), text_.data() + text_.size(), newline_,
                           [&](ObjStatement kind, const char*, const char*, const char* source) {
                             if (kind != wanted || number-- != 0) return true;
                             result = location(source);
                             return false;
                           });
    return result;
  }

  std::string_view text_;
  const std::string& name_;
  Warnings& warnings_;
  char newline_ = '\n';
  std::vector<const char*> borders_;
  std::vector<ObjCounts> starts_;  // what stands before chunk i; the last: in the whole text
  ObjCounts totals_;
  std::vector<Findings> findings_;
  PolygonMesh mesh_;
};

}  // namespace

PolygonMesh read_obj(std::string_view text, const std::string& name, Warnings& warnings) {
  return ObjParser(text, name, warnings).parse();
}

}  // namespace raytree
