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
const ShadingKernels kAvx2Shading{"avx2",
                                  append<8>,
                                  random_pairs<8>,
                                  random_numbers<8>,
                                  sample_positions<8>,
                                  sum_samples<kDoubleLanes<8>>,
                                  find_points<8, kShadingLanes>,
                                  find_flat_points<8>,
                                  load_surfaces<8>,
                                  load_textured<8>,
                                  find_normals<8>,
                                  choose_lights<8, kShadingLanes>,
                                  sample_triangles<8, kShadingLanes>,
                                  sample_punctual<8, kShadingLanes>,
                                  normalize<8, kShadingLanes>,
                                  find_map_places<8, kShadingLanes>,
                                  look_up_map<8, kShadingLanes>,
                                  sample_map<8, kShadingLanes>,
                                  environment_probabilities<8, kShadingLanes>,
                                  split_environment<8, kShadingLanes>,
                                  sample_sphere<8, kShadingLanes>,
                                  mix_environment_pdfs<8, kShadingLanes>,
                                  finish_environment<8, kShadingLanes>,
                                  find_sky_cells<8, kShadingLanes>,
                                  scatter<8>,
                                  sample_guides<8, kShadingLanes>,
                                  guide_pdfs<8, kShadingLanes>,
                                  finish_guided<8>};
}
