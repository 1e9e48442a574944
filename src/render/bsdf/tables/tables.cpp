#include "render/bsdf/tables/tables.hpp"

#include "render/bsdf/tables/anisotropic_schlick_table.hpp"
#include "render/bsdf/tables/coating_schlick_table.hpp"
#include "render/bsdf/tables/refraction_loss_within_table.hpp"

namespace microtrace::bsdf {

constinit const Tables kTables{
    .albedo_f1 = kAlbedoF1[0].data(),
    .albedo_schlick = kAlbedoSchlick[0].data(),
    .mean_albedo_f1 = kMeanAlbedoF1.data(),
    .mean_albedo_schlick = kMeanAlbedoSchlick.data(),
    .anisotropic_loss = kAnisotropicLoss[0][0][0].data(),
    .anisotropic_schlick = kAnisotropicSchlick[0][0][0].data(),
    .mean_anisotropic_loss = kMeanAnisotropicLoss[0].data(),
    .mean_anisotropic_schlick = kMeanAnisotropicSchlick[0].data(),
    .coating_node = kCoatingNode.data(),
    .coating_weight = kCoatingWeight.data(),
    .deficit_f1 = kDeficitF1[0][0].data(),
    .deficit_schlick = kDeficitSchlick[0][0].data(),
    .loss_from_outside = kLossFromOutside[0][0].data(),
    .loss_from_within = kLossFromWithin[0][0].data(),
    .raw_sheen_albedo = kRawSheenAlbedo[0].data(),
    .sheen_albedo = kSheenAlbedo[0].data(),
};

}  // namespace microtrace::bsdf
