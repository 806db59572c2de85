#include "modules/gltf_scene/gltf_values.h"

#include <algorithm>

namespace gnomon {

using tinygltf::Value;

Json to_json(const Value &p_value) {
	switch (p_value.Type()) {
		case tinygltf::REAL_TYPE:
			return p_value.GetNumberAsDouble();
		case tinygltf::INT_TYPE:
			return p_value.GetNumberAsInt();
		case tinygltf::BOOL_TYPE:
			return p_value.Get<bool>();
		case tinygltf::STRING_TYPE:
			return p_value.Get<std::string>();
		case tinygltf::ARRAY_TYPE: {
			Json array = Json::array();
			for (const Value &element : p_value.Get<Value::Array>()) {
				array.push_back(to_json(element));
			}
			return array;
		}
		case tinygltf::OBJECT_TYPE: {
			Json::object_t object; // keys are unique: skips a slow search for each
			for (const auto &[key, member] : p_value.Get<Value::Object>()) {
				object.push_back({ key, to_json(member) });
			}
			return object;
		}
		default:
			return nullptr;
	}
}

Value to_value(const Json &p_json) {
	if (p_json.is_boolean()) {
		return Value(p_json.get<bool>());
	}
	if (p_json.is_number()) {
		const double number = p_json.get<double>();
		const bool fits_int32 =
				p_json.is_number_integer() && number >= INT32_MIN && number <= INT32_MAX;
		return fits_int32 ? Value(p_json.get<int>()) : Value(number);
	}
	if (p_json.is_string()) {
		return Value(p_json.get<std::string>());
	}
	if (p_json.is_array()) {
		Value::Array array;
		for (const Json &element : p_json) {
			array.push_back(to_value(element));
		}
		return Value(std::move(array));
	}
	if (p_json.is_object()) {
		Value::Object object;
		for (auto item = p_json.begin(); item != p_json.end(); ++item) {
			object[item.key()] = to_value(*item);
		}
		return Value(std::move(object));
	}
	return Value();
}

std::optional<GltfObject> find_object(
		const Value &p_value, std::string p_path, GltfMessages &p_messages) {
	if (!p_value.IsObject()) {
		return std::nullopt;
	}
	return GltfObject(std::make_shared<Json>(to_json(p_value)), std::move(p_path), p_messages);
}

const Value *find_extension(const tinygltf::ExtensionMap &p_extensions, const char *p_name) {
	const auto found = p_extensions.find(p_name);
	return found == p_extensions.end() ? nullptr : &found->second;
}

double get_number(const Value &p_object, const char *p_key, double p_default) {
	const bool is_number = p_object.Has(p_key) && p_object.Get(p_key).IsNumber();
	return is_number ? p_object.Get(p_key).GetNumberAsDouble() : p_default;
}

Value::Object &require_object(Value &r_value) {
	if (!r_value.IsObject()) {
		r_value = Value(Value::Object());
	}
	return r_value.Get<Value::Object>();
}

Value::Object &require_extras(Value &r_extras) {
	if (r_extras.Type() != tinygltf::NULL_TYPE && !r_extras.IsObject()) {
		Value::Object members = { { "extras", std::move(r_extras) } };
		r_extras = Value(std::move(members));
	}
	return require_object(r_extras);
}

void declare_extension(tinygltf::Model &r_model, const std::string &p_name) {
	auto &used = r_model.extensionsUsed;
	if (std::find(used.begin(), used.end(), p_name) == used.end()) {
		used.push_back(p_name);
	}
}

} // namespace gnomon
