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
const ShadingKernels kAvx512Shading{"avx512",
                                    append<16>,
                                    random_pairs<16>,
                                    random_numbers<16>,
                                    sample_positions<16>,
                                    sum_samples<kDoubleLanes<16>>,
                                    find_points<16, kShadingLanes>,
                                    find_flat_points<16>,
                                    load_surfaces<16>,
                                    load_textured<16>,
                                    find_normals<16>,
                                    choose_lights<16, kShadingLanes>,
                                    sample_triangles<16, kShadingLanes>,
                                    sample_punctual<16, kShadingLanes>,
                                    normalize<16, kShadingLanes>,
                                    find_map_places<16, kShadingLanes>,
                                    look_up_map<16, kShadingLanes>,
                                    sample_map<16, kShadingLanes>,
                                    environment_probabilities<16, kShadingLanes>,
                                    split_environment<16, kShadingLanes>,
                                    sample_sphere<16, kShadingLanes>,
                                    mix_environment_pdfs<16, kShadingLanes>,
                                    finish_environment<16, kShadingLanes>,
                                    find_sky_cells<16, kShadingLanes>,
                                    scatter<16>,
                                    sample_guides<16, kShadingLanes>,
                                    guide_pdfs<16, kShadingLanes>,
                                    finish_guided<16>};
}
