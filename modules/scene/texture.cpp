#include "modules/scene/texture.h"

#include "modules/core/error.h"
#include "modules/core/files.h"

#include <atomic>

namespace gnomon {

std::shared_ptr<const Image> make_image(
		std::string p_name, glm::uvec2 p_size_px, std::vector<uint8_t> p_texels) {
	static std::atomic<uint64_t> next_id = 1;
	GNOMON_ASSERT(p_size_px.x > 0 && p_size_px.y > 0 &&
					p_texels.size() == size_t(p_size_px.x) * p_size_px.y * 4,
			p_name, p_size_px.x, p_size_px.y, p_texels.size());
	auto image = std::make_shared<Image>();
	image->name = std::move(p_name);
	image->size_px = p_size_px;
	image->texels = std::move(p_texels);
	image->id = next_id++;
	image->content_hash = compute_hash(image->texels, compute_value_hash(p_size_px, /*p_seed=*/1));
	return image;
}

} // namespace gnomon
