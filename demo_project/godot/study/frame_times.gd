class_name FrameTimes
extends RefCounted

const WARM_UP_FRAMES := 10


## The median of `count` frames' milliseconds, after a warm-up; `move` is called with each frame's number before it is drawn.
static func measure(count: int, move: Callable) -> float:
	var samples: Array[float] = []
	var before := 0
	for frame in WARM_UP_FRAMES + count + 1:
		move.call(frame)
		await RenderingServer.frame_post_draw
		var now := Time.get_ticks_usec()
		if frame > WARM_UP_FRAMES:
			samples.append((now - before) / 1000.0)
		before = now
	samples.sort()
	return samples[samples.size() / 2]
