#include "render/film/sample_positions.hpp"
#include "render/film/sum_samples.hpp"
#include "render/guiding/guide_table.hpp"
#include "render/guiding/sky_grid.hpp"
#include "render/kernels/append.hpp"
#include "render/kernels/find_normals.hpp"
#include "render/kernels/finish_guided.hpp"
#include "render/kernels/flat_points.hpp"
#include "render/kernels/sample_environment.hpp"
#include "render/kernels/sample_triangles.hpp"
#include "render/kernels/scatter.hpp"
#include "render/lights/choose_lights.hpp"
#include "render/lights/environment/map_light.hpp"
#include "render/lights/sample_punctual.hpp"
#include "render/sampling/random_pairs.hpp"
#include "render/shading/points/find_points.hpp"
#include "render/textures/load_textured.hpp"

namespace microtrace {
const ShadingKernels kPortableShading{"portable",
                                      append<4>,
                                      random_pairs<4>,
                                      random_numbers<4>,
                                      sample_positions<4>,
                                      sum_samples<kDoubleLanes<4>>,
                                      find_points<4, kShadingLanes>,
                                      find_flat_points<4>,
                                      load_surfaces<4>,
                                      load_textured<4>,
                                      find_normals<4>,
                                      choose_lights<4, kShadingLanes>,
                                      sample_triangles<4, kShadingLanes>,
                                      sample_punctual<4, kShadingLanes>,
                                      normalize<4, kShadingLanes>,
                                      find_map_places<4, kShadingLanes>,
                                      look_up_map<4, kShadingLanes>,
                                      sample_map<4, kShadingLanes>,
                                      environment_probabilities<4, kShadingLanes>,
                                      split_environment<4, kShadingLanes>,
                                      sample_sphere<4, kShadingLanes>,
                                      mix_environment_pdfs<4, kShadingLanes>,
                                      finish_environment<4, kShadingLanes>,
                                      find_sky_cells<4, kShadingLanes>,
                                      scatter<4>,
                                      sample_guides<4, kShadingLanes>,
                                      guide_pdfs<4, kShadingLanes>,
                                      finish_guided<4>};
}
