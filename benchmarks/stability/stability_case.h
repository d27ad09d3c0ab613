// What the stability suite is made of: a case provokes a known failure of a method and measures it, with the remedy on
// and off. Cases do not print and do not judge one another; stability.h runs them all.
#pragma once

#include <atomic>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "geometry/embree_intersector.h"
#include "renderer/display.h"

namespace raytree::benchmarks {

/// Faults that can be planted in the fast path, to see that the suite notices. Cases make every tracer and every offset
/// through these.
struct StabilityFaults {
  bool no_offsets = false;  ///< rays leave exactly where they hit
  bool not_robust = false;  ///< Embree without watertight edges
};

struct StabilityRun {
  StabilityFaults faults;
  /// Share of the full number of rays, frames or samples that a case takes, in (0, 1]. Bounds on rates must allow for
  /// it; a case never takes fewer than its figure needs to mean anything.
  double effort = 1;
  bool pictures = true;  ///< false: figures alone
  const std::atomic<bool>* stop = nullptr;

  EmbreeOptions tracer_options() const {
    EmbreeOptions options;
    options.robust = !faults.not_robust;
    return options;
  }
};

/// What a figure is held to.
enum class StabilityExpectation : std::uint8_t {
  holds,          ///< the renderer's own method: inside [low, high], or it is a defect
  fails_as_known  ///< a method kept for comparison (a classic, or a remedy switched off), that fails as its paper says
};

enum class StabilityVerdict : std::uint8_t { holds, fails_as_known, fails };

/// One method on one provocation.
struct StabilityFigure {
  std::string method;    ///< "Gouraud", "Phong", "offset by error bound"
  std::string quantity;  ///< "highlight's longest radius / shortest"
  double measured = std::numeric_limits<double>::quiet_NaN();
  double low = 0, high = 0;  ///< where it must lie, both ends included
  std::string known;         ///< the best figure known or predicted and where from: "sqrt 2 (Phong 1973, I.2)"
  StabilityExpectation expectation = StabilityExpectation::holds;

  /// `fails` also where nothing was measured (NaN).
  StabilityVerdict verdict() const {
    if (!(measured >= low && measured <= high)) return StabilityVerdict::fails;
    return expectation == StabilityExpectation::holds ? StabilityVerdict::holds : StabilityVerdict::fails_as_known;
  }
};

/// Of the renderer's own method: inside [low, high], or it is a defect.
inline StabilityFigure held(std::string method, std::string quantity, double measured, double low, double high,
                            std::string known) {
  return {std::move(method), std::move(quantity), measured, low, high, std::move(known), StabilityExpectation::holds};
}

/// Of a method that is kept to be compared with, and fails inside [low, high] as it is known to.
inline StabilityFigure known_failure(std::string method, std::string quantity, double measured, double low, double high,
                                     std::string known) {
  StabilityFigure figure = held(std::move(method), std::move(quantity), measured, low, high, std::move(known));
  figure.expectation = StabilityExpectation::fails_as_known;
  return figure;
}

/// A failure beside its remedy, or beside the truth; display-referred.
struct StabilityPicture {
  std::string caption;
  DisplayImage image;
  int magnified = 1;  ///< pixels of the page, each way, that one of the image takes; its borders stay hard
};

/// A figure over a knob, for the page. Points that are not finite are left out, and on a logarithmic axis those that
/// are not positive.
struct StabilityGraph {
  enum class Scale : std::uint8_t { logarithmic, linear };
  struct Line {
    std::string name;
    std::vector<std::pair<double, double>> points;
    bool predicted = false;  ///< drawn dashed
  };
  std::string title, x_label, y_label;
  std::vector<Line> lines;
  Scale x_scale = Scale::logarithmic, y_scale = Scale::logarithmic;
};

/// What a case shows. With StabilityRun::pictures it has a picture or a graph, or says why there is nothing to see.
struct StabilityResult {
  std::vector<StabilityFigure> figures;
  std::vector<StabilityPicture> pictures;
  std::vector<StabilityGraph> graphs;
  std::string nothing_to_see = {};  ///< a sentence; empty: there is something
};

struct StabilityCase {
  int row = 0;              ///< of the catalogue in docs/stability.md
  const char* name;         ///< for --filter: "gouraud-highlight-shape"
  const char* title;        ///< "The shape of a highlight by Gouraud"
  const char* provocation;  ///< what is done to the method
  const char* remedy;       ///< what helps, and that it is switched off in some figures
  const char* source;       ///< paper and place, or where the failure was reported
  StabilityResult (*run)(const StabilityRun& run);
};

/// The suite's parts, each a file of its own.
std::vector<StabilityCase> facet_cases();         ///< rows 1-7, 11-19: shading of facets
std::vector<StabilityCase> sampling_cases();      ///< rows 20-23: what falls between samples
std::vector<StabilityCase> ray_tree_cases();      ///< rows 24-35: the tree, optics, media, attenuation
std::vector<StabilityCase> intersection_cases();  ///< rows 36-50: Embree, offsets, scale, degenerate input
std::vector<StabilityCase> curved_cases();        ///< rows 8-10, 51-58 and 66: patches and subdivision
std::vector<StabilityCase> picture_cases();       ///< rows 59-65: numbers on the way to a file, determinism

}  // namespace raytree::benchmarks
