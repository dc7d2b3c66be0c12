#pragma once
// Library files as parts of a frozen scene, in decoded form.
#include <memory>

#include "core/model/resources.h"
#include "io/scene/frozen_parts.h"

namespace lightwalk {

void freeze_data(const DataArray& data, std::uint32_t number, FrozenParts& parts);
void freeze_picture(const PictureData& picture, std::uint32_t number, FrozenParts& parts);
void freeze_spectral_picture(const SpectralPicture& picture, std::uint32_t number,
                             FrozenParts& parts);
void freeze_font(const Font& font, std::uint32_t number, FrozenParts& parts);

// The inverse of the functions above. They throw InputError for contents that no decoder can have
// made, as far as a scene relies on them.
[[nodiscard]] std::shared_ptr<const DataArray> map_data(const FrozenFile& file,
                                                        std::uint32_t number);
[[nodiscard]] std::shared_ptr<const PictureData> map_picture(const FrozenFile& file,
                                                             std::uint32_t number);
[[nodiscard]] std::shared_ptr<const SpectralPicture> map_spectral_picture(const FrozenFile& file,
                                                                          std::uint32_t number);
[[nodiscard]] std::shared_ptr<const Font> map_font(const FrozenFile& file, std::uint32_t number);

}  // namespace lightwalk
