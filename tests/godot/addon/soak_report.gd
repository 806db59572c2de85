class_name SoakReport
extends RefCounted
## Resource counts of the soak tests, which test_soak.py compares between frames.


## Prints Godot's resource counts as "SOAK frame objects nodes resources textures_bytes buffers_bytes video_bytes memory_kib".
static func print_line(frame: int) -> void:
	var device := RenderingServer.get_rendering_device()
	print("SOAK %d %d %d %d %d %d %d %d" % [
		frame,
		Performance.get_monitor(Performance.OBJECT_COUNT),
		Performance.get_monitor(Performance.OBJECT_NODE_COUNT),
		Performance.get_monitor(Performance.OBJECT_RESOURCE_COUNT),
		device.get_memory_usage(RenderingDevice.MEMORY_TEXTURES),
		device.get_memory_usage(RenderingDevice.MEMORY_BUFFERS),
		device.get_memory_usage(RenderingDevice.MEMORY_TOTAL),
		_read_memory_kib(),
	])


## Returns the resident memory of the process, from Linux's /proc.
static func _read_memory_kib() -> int:
	var file := FileAccess.open("/proc/self/status", FileAccess.READ)
	while not file.eof_reached():
		var line := file.get_line()
		if line.begins_with("VmRSS:"):
			return int(line)
	return 0
