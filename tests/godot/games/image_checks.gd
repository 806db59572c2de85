class_name ImageChecks
extends RefCounted
## Comparisons of images of 8 bits per channel, encoded as sRGB.

const RADIUS_PX := 3
const FLAT_RANGE := 0.1  # of shares within RADIUS_PX
const LEAST_LIGHT := 0.03  # linear luminance that the lights add to a pixel whose share of light is computed
const NO_SHARE := -1.0


## Returns how many pixels of an image are darker than those of another by more than `tolerance`, in any channel.
static func count_darker(image: Image, lower_limit: Image, tolerance: int) -> int:
	var found := image.get_data()
	var limit := lower_limit.get_data()
	var count := 0
	for pixel in range(0, found.size(), 3):
		count += int(found[pixel] + tolerance < limit[pixel] or found[pixel + 1] + tolerance < limit[pixel + 1]
				or found[pixel + 2] + tolerance < limit[pixel + 2])
	return count


## Returns how many pixels differ by more than `tolerance` in any channel.
static func count_different(left: Image, right: Image, tolerance: int) -> int:
	var a := left.get_data()
	var b := right.get_data()
	var count := 0
	for pixel in range(0, a.size(), 3):
		count += int(absi(a[pixel] - b[pixel]) > tolerance or absi(a[pixel + 1] - b[pixel + 1]) > tolerance
				or absi(a[pixel + 2] - b[pixel + 2]) > tolerance)
	return count


## Returns how many pixels have all channels below `dark` where a channel of the other image is `light` or more.
static func count_black(image: Image, reference: Image, dark: int, light: int) -> int:
	var found := image.get_data()
	var expected := reference.get_data()
	var count := 0
	for pixel in range(0, found.size(), 3):
		count += int(maxi(found[pixel], maxi(found[pixel + 1], found[pixel + 2])) < dark
				and maxi(expected[pixel], maxi(expected[pixel + 1], expected[pixel + 2])) >= light)
	return count


## Returns for each pixel which share of the lights' light it has, 0 in the umbra of all lights, 1 without shadow. NO_SHARE where the lights
## add less than LEAST_LIGHT.
static func compute_shares(image: Image, unlit: Image, unshadowed: Image) -> PackedFloat32Array:
	var table := _make_table()
	var found := _compute_luminance(image, table)
	var lowest := _compute_luminance(unlit, table)
	var highest := _compute_luminance(unshadowed, table)
	for pixel in found.size():
		var light := highest[pixel] - lowest[pixel]
		found[pixel] = (found[pixel] - lowest[pixel]) / light if light >= LEAST_LIGHT else NO_SHARE
	return found


## Returns how many pixels have a share that is more than `tolerance` (x) below or (y) above all shares of the other image within RADIUS_PX.
## Pixels at the edge of a shadow in the other image are therefore compared with both of its sides.
static func count_outside(shares: PackedFloat32Array, others: PackedFloat32Array, width: int, tolerance: float) -> Vector2i:
	var lowest := find_extremes(others, width, -1.0)
	var highest := find_extremes(others, width, 1.0)
	var counts := Vector2i.ZERO
	for pixel in shares.size():
		if shares[pixel] != NO_SHARE:
			counts.x += int(shares[pixel] < lowest[pixel] - tolerance)
			counts.y += int(shares[pixel] > highest[pixel] + tolerance)
	return counts


## Returns how many pixels have a share, and neighbours with nearly the same share.
static func count_flat(shares: PackedFloat32Array, width: int) -> int:
	var lowest := find_extremes(shares, width, -1.0)
	var highest := find_extremes(shares, width, 1.0)
	var count := 0
	for pixel in shares.size():
		count += int(shares[pixel] != NO_SHARE and highest[pixel] - lowest[pixel] <= FLAT_RANGE)
	return count


## Returns an image that shows shares: NO_SHARE blue.
static func make_share_image(shares: PackedFloat32Array, width: int) -> Image:
	@warning_ignore("integer_division")
	var image := Image.create_empty(width, shares.size() / width, false, Image.FORMAT_RGB8)
	for pixel in shares.size():
		var share := shares[pixel]
		@warning_ignore("integer_division")
		image.set_pixel(pixel % width, pixel / width, Color.BLUE if share == NO_SHARE else Color(share, share, share))
	return image


## Returns the largest (direction 1) or smallest (direction -1) share within RADIUS_PX of each pixel that has one.
static func find_extremes(shares: PackedFloat32Array, width: int, direction: float) -> PackedFloat32Array:
	var signed := PackedFloat32Array()
	signed.resize(shares.size())
	for pixel in shares.size():
		signed[pixel] = direction * shares[pixel] if shares[pixel] != NO_SHARE else -INF
	var result := _find_maxima(_find_maxima(signed, width, 1), width, width)
	for pixel in result.size():
		result[pixel] *= direction
	return result


static func _find_maxima(values: PackedFloat32Array, width: int, stride: int) -> PackedFloat32Array:
	var result := values.duplicate()
	for pixel in values.size():
		var best := values[pixel]
		for offset in range(-RADIUS_PX, RADIUS_PX + 1):
			var other := pixel + offset * stride
			if other < 0 or other >= values.size():
				continue
			@warning_ignore("integer_division")
			if stride == 1 and other / width != pixel / width:
				continue
			best = maxf(best, values[other])
		result[pixel] = best
	return result


static func _make_table() -> PackedFloat32Array:
	var table := PackedFloat32Array()
	for value in 256:
		table.append(Color8(value, 0, 0).srgb_to_linear().r)
	return table


static func _compute_luminance(image: Image, table: PackedFloat32Array) -> PackedFloat32Array:
	var data := image.get_data()
	var luminance := PackedFloat32Array()
	@warning_ignore("integer_division")
	luminance.resize(data.size() / 3)
	for pixel in luminance.size():
		var first := 3 * pixel
		luminance[pixel] = 0.2126 * table[data[first]] + 0.7152 * table[data[first + 1]] + 0.0722 * table[data[first + 2]]
	return luminance
