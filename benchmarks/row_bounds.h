// What the rows of `./run measure` are held to: one place for the rows, and for the list of lines that README's table
// is checked against.
#pragma once

namespace raytree::benchmarks {

inline constexpr double kLeastFloor = 0.55, kChasedFloor = 0.65;    ///< bare calls / tracing phase
inline constexpr double kLeastWaves = 1.2, kLeastWavesOfTwo = 1.4;  ///< recursion / generations, by threads
inline constexpr double kLeastThreads = 1.75;                       ///< one thread's time / two threads'
inline constexpr double kMostFirstRaySeconds = 0.030;               ///< from launch
inline constexpr double kMostFileRatio = 1.15;                      ///< launch to file / loading OpenImageIO
inline constexpr double kMostLargeTime = 1.25, kMostLargeMemory = 1.15;
inline constexpr double kMostIdlePercent = 2;                        ///< instructions of what a scene does not use
inline constexpr double kLeastPlySpeed = 300, kLeastObjSpeed = 100;  ///< MB/s
inline constexpr double kMostLoadingMemory = 2.5;                    ///< peak / arrays kept
inline constexpr double kLeastBenchShare = 0.95;                     ///< bare calls / raytree bench
inline constexpr double kMostInstancesGibibytes = 0.3, kMostOverBare = 1.1;
inline constexpr double kLeastTypesShare = 0.9;  ///< triangles alone / with spheres
/// What a ratio differs by between machines for no reason that is known: `raytree bench terrain --isa avx2` in place of
/// `--isa avx512`, on one machine, moves three of four ratios by no more.
inline constexpr double kBetweenMachines = 0.08;
inline constexpr double kLeastRegularSpeed = 6, kLeastIrregularSpeed = 4;  ///< million limit points a second and core
inline constexpr double kMostCracks = 0;                                   ///< rays at shared edges that slip through
/// Tolerance of the surface that outlines are compared with, over the default one: facets about a third as large as
/// usual, or, of a cage of ten thousand faces, half as large.
inline constexpr double kFinerTolerance = 1.0 / 8, kFinerToleranceOfMany = 1.0 / 4;
inline constexpr double kLeastPovrayTrace = 5, kLeastPovrayRay = 2.5, kLeastPovrayAdaptive = 5, kLeastPovrayLaunch = 8;
inline constexpr double kMostPovrayDiffering = 0;  ///< percent of pixels, of row povray
/// The same of row povray-masks: at terminators and where shadows are thinner than our samples lie apart, both round
/// their own way.
inline constexpr double kMostMaskDiffering = 0.01;

}  // namespace raytree::benchmarks
