#include "modules/gltf_scene/gltf_side_files.h"

#include "modules/core/error.h"
#include "modules/core/files.h"
#include "modules/core/log.h"

namespace gnomon {

namespace fs = std::filesystem;

namespace {

bool is_same_folder(const fs::path &p_first, const fs::path &p_second) {
	std::error_code code;
	return fs::equivalent(p_first, p_second, code);
}

/// Adds the file that an element's relative URI names to r_files, and writes its new URI.
/// A file that cannot be read throws an Error if it is required, and is otherwise only logged.
void copy_uri_file(const GltfObject &p_object, const GltfLocation &p_location, bool p_is_required,
		GltfSideFiles &r_files) {
	const Json *uri = p_object.find("uri");
	if (!uri || !uri->is_string() || is_data_uri(uri->get_ref<const std::string &>())) {
		return;
	}
	try {
		const fs::path path =
				resolve_uri(uri->get_ref<const std::string &>(), p_location, p_object);
		std::vector<uint8_t> bytes = load_file(path, GLTF_MAX_FILE_BYTES);
		p_object.set("uri", encode_uri(r_files.add(path.filename().string(), std::move(bytes))));
	} catch (const Error &error) {
		if (p_is_required) {
			throw;
		}
		log_warning("Image not copied: ", error.what());
	}
}

} // namespace

GltfSideFiles::GltfSideFiles(fs::path p_folder) : folder(std::move(p_folder)) {}

bool GltfSideFiles::is_name_taken(
		const std::string &p_name, const std::vector<uint8_t> &p_bytes) const {
	if (const auto found = files.find(p_name); found != files.end()) {
		return found->second != p_bytes;
	}
	std::error_code code;
	const fs::path path = folder / make_path(p_name);
	if (!fs::exists(fs::symlink_status(path, code))) { // a broken symbolic link exists too
		return false;
	}
	return fs::file_size(path, code) != p_bytes.size() || code ||
			load_file(path, GLTF_MAX_BUFFER_BYTES) != p_bytes;
}

std::string GltfSideFiles::add(const std::string &p_requested_name, std::vector<uint8_t> p_bytes) {
	std::string name = p_requested_name;
	for (size_t number = 2; is_name_taken(name, p_bytes); ++number) {
		name = make_numbered_name(p_requested_name, number);
	}
	files[name] = std::move(p_bytes);
	return name;
}

std::string GltfSideFiles::make_numbered_name(const std::string &p_name, size_t p_number) {
	const fs::path path = make_path(p_name);
	return p_number < 2 ? p_name
						: text(path.stem().string(), "_", p_number, path.extension().string());
}

void GltfSideFiles::save() const {
	for (const auto &[name, bytes] : files) {
		save_file_atomically(folder / make_path(name), bytes);
	}
}

void relocate_container(const GltfDocument &p_document, const fs::path &p_target,
		GltfFormat p_format, Json &r_json, GltfContainer &r_container, GltfSideFiles &r_files) {
	GltfMessages messages{ p_document.file, {} };
	const GltfObject root(r_json, "", messages);
	const size_t buffer_count = root.get_count("buffers");
	const auto &bin_chunk = p_document.container.bin_chunk;
	const fs::path folder = fs::absolute(p_target).parent_path();
	const bool is_moved = !is_same_folder(folder, p_document.location.folder);
	for (size_t index = 0; index < buffer_count; ++index) {
		const GltfObject buffer = root.get_element("buffers", index);
		if (index == 0 && p_format == GltfFormat::BINARY && !bin_chunk && buffer.find("uri")) {
			GltfBuffers buffers(root, p_document.location, /*p_bin_chunk=*/nullptr);
			const auto bytes = buffers.load_buffer(index);
			r_container.bin_chunk.emplace(bytes.begin(), bytes.end());
			buffer.erase("uri");
		} else if (index == 0 && p_format == GltfFormat::TEXT && bin_chunk && !buffer.find("uri")) {
			const std::string name = p_target.stem().string() + ".bin";
			buffer.set("uri", encode_uri(r_files.add(name, *bin_chunk)));
		} else if (is_moved) {
			copy_uri_file(buffer, p_document.location, /*p_is_required=*/true, r_files);
		}
	}
	if (p_format == GltfFormat::TEXT) {
		r_container.bin_chunk.reset();
		r_container.other_chunks.clear();
	}
	const size_t image_count = is_moved ? root.get_count("images") : 0;
	for (size_t index = 0; index < image_count; ++index) {
		copy_uri_file(root.get_element("images", index), p_document.location,
				/*p_is_required=*/false, r_files);
	}
}

} // namespace gnomon
