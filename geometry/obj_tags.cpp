#include "geometry/obj_tags.h"

#include <cmath>
#include <string_view>
#include <vector>

#include "geometry/text_scanning.h"

namespace raytree {
namespace {

using namespace text;

struct Tag {
  std::vector<std::int64_t> integers;
  std::vector<double> numbers;
  std::vector<std::string_view> words;
};

class TagScanner {
 public:
  TagScanner(const char* p, const char* end, const ObjTagLimits& limits, std::string& error)
      : p_(p), end_(end), limits_(limits), error_(error) {}

  std::string_view word() {
    p_ = skip_blanks(p_, end_);
    const char* const begin = p_;
    while (p_ != end_ && !is_blank(*p_) && *p_ != '#') ++p_;
    return {begin, static_cast<std::size_t>(p_ - begin)};
  }

  /// Counts and what they announce.
  bool read(Tag& tag) {
    p_ = skip_blanks(p_, end_);
    std::int64_t counts[3];
    for (int i = 0; i < 3; ++i) {
      const char* const after = scan_integer(p_, end_, counts[i]);
      if (!after || counts[i] < 0 || (i < 2 && (after == end_ || *after != '/')))
        return fail("a subdivision tag needs three counts like 2/1/0 after its name");
      p_ = i < 2 ? after + 1 : after;
    }
    // An announced count reserves nothing: the text decides how many there are.
    for (std::int64_t i = 0; i < counts[0]; ++i) {
      const std::string_view text = word();
      std::int64_t value = 0;
      if (text.empty() || scan_integer(text.data(), text.data() + text.size(), value) != text.data() + text.size())
        return fail_value(text, "an integer");
      tag.integers.push_back(value);
    }
    for (std::int64_t i = 0; i < counts[1]; ++i) {
      const std::string_view text = word();
      double value = 0;
      if (text.empty() || scan_double(text.data(), text.data() + text.size(), value) != text.data() + text.size())
        return fail_value(text, "a number");
      tag.numbers.push_back(value);
    }
    for (std::int64_t i = 0; i < counts[2]; ++i) {
      tag.words.push_back(word());
      if (tag.words.back().empty()) return fail_value({}, "a word");
    }
    if (const std::string_view more = word(); !more.empty())
      return fail("the subdivision tag has more values than it announces: " + in_quotes(more));
    return true;
  }

  bool creases(const Tag& tag, SubdivisionRules& rules) {
    const std::size_t edges = tag.integers.size() / 2;
    if (edges == 0 || tag.integers.size() % 2 != 0) return fail("a crease needs pairs of vertices");
    for (std::size_t i = 0; i < edges; ++i) {
      Crease crease;
      for (const std::size_t k : {2 * i, 2 * i + 1}) {
        if (!check_index(tag.integers[k], "vertex", limits_.vertices)) return false;
        crease.vertices.push_back(static_cast<std::uint32_t>(tag.integers[k]));
      }
      if (crease.vertices[0] == crease.vertices[1]) return fail("the crease goes from a vertex to itself");
      if (!sharpness(tag, i, edges, crease.sharpness)) return false;
      rules.creases.push_back(std::move(crease));
    }
    return true;
  }

  bool corners(const Tag& tag, SubdivisionRules& rules) {
    if (tag.integers.empty()) return fail("a corner needs a vertex");
    for (std::size_t i = 0; i < tag.integers.size(); ++i) {
      SharpCorner corner;
      if (!check_index(tag.integers[i], "vertex", limits_.vertices)) return false;
      corner.vertex = static_cast<std::uint32_t>(tag.integers[i]);
      if (!sharpness(tag, i, tag.integers.size(), corner.sharpness)) return false;
      rules.corners.push_back(corner);
    }
    return true;
  }

  bool holes(const Tag& tag, SubdivisionRules& rules) {
    for (const std::int64_t face : tag.integers) {
      if (!check_index(face, "face", limits_.faces)) return false;
      rules.holes.push_back(static_cast<std::uint32_t>(face));
    }
    return true;
  }

  /// One integer that chooses; `choices` says of what.
  template <class Rule, std::size_t kCount>
  bool choice(const Tag& tag, const Rule (&rules)[kCount], const char* choices, std::optional<Rule>& rule) {
    if (tag.integers.size() != 1 || tag.integers[0] < 0 || tag.integers[0] >= static_cast<std::int64_t>(kCount))
      return fail(std::string("the tag takes one integer: ") + choices);
    rule = rules[tag.integers[0]];
    return true;
  }

  /// One of two words that chooses.
  template <class Rule>
  bool choice(const Tag& tag, std::string_view first, Rule first_rule, std::string_view second, Rule second_rule,
              std::optional<Rule>& rule) {
    const bool is_first = tag.words.size() == 1 && tag.words[0] == first;
    if (!is_first && !(tag.words.size() == 1 && tag.words[0] == second))
      return fail("the tag takes one word: " + std::string(first) + " or " + std::string(second));
    rule = is_first ? first_rule : second_rule;
    return true;
  }

  bool fail(const std::string& message) {
    error_ = message;
    return false;
  }

 private:
  bool fail_value(std::string_view text, const char* expected) {
    return fail(text.empty() ? "the subdivision tag has fewer values than it announces"
                             : in_quotes(text) + " is not " + expected);
  }

  bool check_index(std::int64_t index, const char* what, std::size_t count) {
    if (index >= 0 && index < static_cast<std::int64_t>(count)) return true;
    return fail("the tag names " + std::string(what) + " " + std::to_string(index) + "; there are " +
                std::to_string(count) + " in the file, which tags count from 0");
  }

  /// One number for all, or one for each.
  bool sharpness(const Tag& tag, std::size_t index, std::size_t count, double& value) {
    if (tag.numbers.size() != 1 && tag.numbers.size() != count)
      return fail("the tag needs one sharpness for all, or one for each");
    value = tag.numbers[tag.numbers.size() == 1 ? 0 : index];
    // NaN fails the comparison.
    return value >= 0 ? true : fail("a sharpness must be a number, 0 or larger");
  }

  const char* p_;
  const char* end_;
  const ObjTagLimits& limits_;
  std::string& error_;
};

}  // namespace

bool scan_obj_tag(const char* p, const char* end, const ObjTagLimits& limits, const char* source,
                  ObjTagFindings& findings, std::string& error) {
  TagScanner scanner(p, end, limits, error);
  const std::string_view name = scanner.word();
  if (name == "vertexedit" || name == "edgeedit" || name == "faceedit") {
    findings.edits.add(source);
    return true;
  }
  const bool known = name == "crease" || name == "corner" || name == "hole" || name == "interpolateboundary" ||
                     name == "facevaryinginterpolateboundary" || name == "creasemethod" || name == "smoothtriangles";
  if (!known) {
    findings.unknown.add(source);
    return true;
  }
  Tag tag;
  if (!scanner.read(tag)) return false;
  findings.any = true;
  SubdivisionRules& rules = findings.rules;
  if (name == "crease") return scanner.creases(tag, rules);
  if (name == "corner") return scanner.corners(tag, rules);
  if (name == "hole") return scanner.holes(tag, rules);
  if (name == "interpolateboundary")
    return scanner.choice(tag, {BoundaryRule::none, BoundaryRule::edge_and_corner, BoundaryRule::edge_only},
                          "0 none, 1 edge and corner, 2 edge only", rules.boundary);
  if (name == "facevaryinginterpolateboundary")
    return scanner.choice(tag,
                          {FaceVaryingRule::none, FaceVaryingRule::corners_only, FaceVaryingRule::corners_plus1,
                           FaceVaryingRule::corners_plus2, FaceVaryingRule::boundaries, FaceVaryingRule::all},
                          "0 none, 1 corners only, 2 corners plus 1, 3 corners plus 2, 4 boundaries, 5 all",
                          rules.face_varying);
  if (name == "creasemethod")
    return scanner.choice(tag, "normal", CreaseMethod::uniform, "chaikin", CreaseMethod::chaikin, rules.crease_method);
  return scanner.choice(tag, "catmark", TriangleRule::catmark, "smooth", TriangleRule::smooth, rules.triangles);
}

}  // namespace raytree
