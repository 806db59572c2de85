#include "modules/gltf_scene/gltf_document.h"

#include "modules/core/error.h"
#include "modules/gltf_scene/gltf_values.h"

#include <sstream>

namespace gnomon {

namespace {

/// Replaces every buffer by one of three bytes, because tinygltf loads buffers while parsing,
/// supports few media types and compares byteLength.
const char STUB_URI[] = "data:application/octet-stream;base64,AAAA";
const int STUB_BYTES = 3;

/// Converts whole numbers that tinygltf's integers cannot represent to doubles, because tinygltf
/// would truncate them.
void widen_integers(Json &r_json) {
	if (r_json.is_structured()) {
		for (Json &element : r_json) {
			widen_integers(element);
		}
	} else if (r_json.is_number_integer() && (r_json > INT32_MAX || r_json < INT32_MIN)) {
		r_json = r_json.get<double>();
	}
}

/// Applies widen_integers to the extras and extensions of all elements.
void widen_extras(Json &r_json) {
	if (!r_json.is_structured()) {
		return;
	}
	for (auto item = r_json.begin(); item != r_json.end(); ++item) {
		if (r_json.is_object() && (item.key() == "extras" || item.key() == "extensions")) {
			widen_integers(*item);
		} else {
			widen_extras(*item);
		}
	}
}

/// Prepares the document for tinygltf: it must not load buffers and images, nor decode meshes.
void prepare_for_tinygltf(Json &r_json) {
	for (Json &buffer : r_json["buffers"]) {
		buffer["uri"] = STUB_URI;
		buffer["byteLength"] = STUB_BYTES;
	}
	for (Json &image : r_json["images"]) {
		image.erase("bufferView");
		image["uri"] = "image"; // never opened, see make_callbacks
	}
	for (Json &mesh : r_json["meshes"]) {
		for (Json &primitive : mesh["primitives"]) {
			const auto extensions = primitive.find("extensions");
			if (extensions != primitive.end() && extensions->is_object()) {
				extensions->erase("KHR_draco_mesh_compression"); // else tinygltf decodes it
			}
		}
	}
	widen_extras(r_json);
}

/// Returns callbacks that keep tinygltf from accessing files.
tinygltf::FsCallbacks make_callbacks() {
	tinygltf::FsCallbacks callbacks = {};
	callbacks.FileExists = [](const std::string &, void *) { return false; };
	callbacks.ExpandFilePath = [](const std::string &p_path, void *) { return p_path; };
	callbacks.ReadWholeFile = [](std::vector<unsigned char> *, std::string *, const std::string &,
									  void *) { return false; };
	callbacks.WriteWholeFile = [](std::string *, const std::string &,
									   const std::vector<unsigned char> &,
									   void *) { return false; };
	return callbacks;
}

/// Corrects two violations of the specification in tinygltf's output: null for an object without
/// members (in an array it becomes {}, elsewhere it is removed), and 0 for an infinite far plane
/// (which is removed).
void fix_written_json(Json &r_json) {
	if (r_json.is_array()) {
		for (Json &element : r_json) {
			if (element.is_null()) {
				element = Json::object();
			}
			fix_written_json(element);
		}
	} else if (r_json.is_object()) {
		for (auto item = r_json.begin(); item != r_json.end();) {
			if (item->is_null() || (item.key() == "zfar" && *item == 0)) {
				item = r_json.erase(item);
			} else {
				fix_written_json(*item++);
			}
		}
	}
}

Json write_model(const tinygltf::Model &p_model) {
	tinygltf::TinyGLTF writer;
	writer.SetImageWriter(nullptr, nullptr);
	std::ostringstream stream;
	try {
		writer.WriteGltfSceneToStream(
				&p_model, stream, /*prettyPrint=*/false, /*writeBinary=*/false);
	} catch (const std::exception &error) {
		fail("The scene cannot be saved: ", to_one_line(error.what()),
				". Change the names of its nodes to plain text.");
	}
	Json json = Json::parse(stream.str());
	fix_written_json(json);
	return json;
}

bool is_list_of_objects(const Json &p_json) {
	return p_json.is_array() && !p_json.empty() && p_json[0].is_object();
}

/// Applies the differences between p_before and p_after, both written by tinygltf, to p_read, the
/// JSON as it was read.
Json merge(const Json &p_read, const Json &p_before, Json p_after) {
	if (p_before == p_after) {
		return p_read;
	}
	if (is_list_of_objects(p_read) && is_list_of_objects(p_after) &&
			p_before.size() == p_read.size() && p_after.size() >= p_read.size()) {
		for (size_t index = 0; index < p_read.size(); ++index) {
			p_after[index] = merge(p_read[index], p_before[index], std::move(p_after[index]));
		}
		return p_after;
	}
	if (!p_read.is_object() || !p_after.is_object()) {
		return p_after;
	}
	const Json nothing;
	const auto find = [&](const Json &p_object, const std::string &p_key) -> const Json & {
		const auto found = p_object.find(p_key);
		return found == p_object.end() ? nothing : *found;
	};
	Json merged = Json::object();
	for (auto item = p_read.begin(); item != p_read.end(); ++item) {
		const Json &before = find(p_before, item.key());
		const auto after = p_after.find(item.key());
		if (after != p_after.end()) {
			merged[item.key()] = merge(*item, before, *after);
		} else if (before.is_null()) { // tinygltf does not store it
			merged[item.key()] = *item;
		} else if (item->is_object()) {
			// Removed, except for the members that tinygltf does not store.
			Json rest = merge(*item, before, Json::object());
			if (!rest.empty()) {
				merged[item.key()] = std::move(rest);
			}
		}
	}
	for (auto item = p_after.begin(); item != p_after.end(); ++item) {
		if (!p_read.contains(item.key()) && *item != find(p_before, item.key())) {
			merged[item.key()] = std::move(*item);
		}
	}
	return merged;
}

} // namespace

tinygltf::Model parse_gltf_model(Json p_checked, const GltfMessages &p_messages) {
	prepare_for_tinygltf(p_checked);
	const std::string json = p_checked.dump();
	tinygltf::TinyGLTF parser;
	parser.SetFsCallbacks(make_callbacks());
	tinygltf::Model model;
	std::string problem;
	std::string warning;
	if (!parser.LoadASCIIFromString(&model, &problem, &warning, json.data(),
				static_cast<unsigned>(json.size()),
				/*base_dir=*/"")) {
		throw Error(p_messages.describe(
				"JSON", text("is not valid: ", problem, " Correct it or export the file again.")));
	}
	for (tinygltf::Buffer &buffer : model.buffers) {
		buffer.data.clear();
	}
	return model;
}

Json write_gltf_model(
		const tinygltf::Model &p_model, const Json *p_read, const tinygltf::Model *p_before) {
	Json written = write_model(p_model);
	return p_read ? merge(*p_read, write_model(*p_before), std::move(written)) : written;
}

} // namespace gnomon
