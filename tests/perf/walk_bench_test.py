#!/usr/bin/python3
"""What perf/walk_bench.py computes without drawing anything: differences of pictures, masks, views, key frames."""
import contextlib, io, json, pathlib, sys, tempfile, types, unittest

try:
    import numpy
except ImportError:
    print("NumPy is not installed: skipped")
    sys.exit(77)

PERF = pathlib.Path(__file__).resolve().parents[2] / "perf"
sys.path += [str(PERF), str(PERF / "scaling")]

from walk import interpolated, moves, pictures, regions, stage, truth, views, ways  # noqa: E402


def write_hdr(path, rows, head="#?RADIANCE\nVIEW= -vtv -vp 1 2 3\n\n"):
    """A picture of rows of bytes, each as they stand in the file."""
    width = len(rows[0]) // 4 if rows[0][:2] != b"\2\2" else rows[0][2] * 256 + rows[0][3]
    path.write_bytes(head.encode() + f"-Y {len(rows)} +X {width}\n".encode() + b"".join(rows))


class Pictures(unittest.TestCase):
    def test_rows_are_read_flat_and_in_runs(self):
        flat = bytes([128, 64, 0, 129] * 8)
        runs = b"\2\2\0\10" + bytes([136, 128, 136, 64, 8]) + bytes(8) + bytes([136, 129])
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "p.hdr"
            write_hdr(path, [flat, runs])
            found = pictures.read_hdr(path)
            self.assertEqual(pictures.view_of(path), "-vtv -vp 1 2 3")
        self.assertEqual(found.shape, (2, 8, 3))
        for value, byte in zip(found[0, 0], (128, 64, 0)):
            self.assertEqual(value, (byte + 0.5) / 128)
        numpy.testing.assert_array_equal(found[0], found[1])

    def test_the_longest_piece_without_a_run_has_128_values(self):
        values = bytes(range(1, 129))
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "p.hdr"
            exponents = bytes([255, 136, 129, 136])
            write_hdr(path, [b"\2\2\0\200" + 3 * (bytes([128]) + values) + exponents])
            found = pictures.read_hdr(path)
        numpy.testing.assert_array_equal(found[0, :, 1], numpy.arange(1, 129) + 0.5)

    def test_a_pixel_is_off_from_a_tenth_on(self):
        should = numpy.array([[1.0, 1, 1, 1, 0]])
        is_ = numpy.array([[1.09, 1.11, 0.91, 0.89, 0.1]])
        self.assertEqual(pictures.off(is_, should).tolist(), [[False, True, False, True, True]])

    def test_pictures_moved_half_a_pixel_and_by_pixels_from_there_are_not_beyond(self):
        """A step of brightness through the middle of pixels: whatever a ray within half a pixel sees is allowed."""
        def seen(x, y):  # pixels from the lower left
            return numpy.where(x + 0.2 * y > 4.0, 2.0, 1.0)

        height, width = 6, 8
        y, x = numpy.mgrid[height - 1:-1:-1, 0:width] + 0.5
        should, moved = seen(x, y), seen(x + 0.5, y + 0.5)
        for right, up in ((0.5, 0.5), (-0.5, 0.5), (0.5, -0.5), (-0.5, -0.5)):
            is_ = seen(x + right, y + up)
            inner = pictures.beyond(is_, should, moved)[:-1, 1:]
            self.assertFalse(inner.any(), (right, up))
        self.assertTrue(pictures.off(seen(x - 0.5, y), should).any())
        self.assertTrue(pictures.beyond(seen(x - 1.5, y), should, moved).any())
        self.assertTrue(pictures.beyond(seen(x, y - 8), should, moved).any())

    def test_errors_are_red_and_white_where_no_neighbour_explains_them(self):
        should = numpy.ones((5, 6))
        should[1, 2] = 2
        is_ = should.copy()
        is_[1, 2], is_[2, 3], is_[4, 5], is_[4, 0] = 1, 2, 2, 1.05
        found = pictures.error_image(is_, should)
        self.assertEqual(found[1, 2].tolist(), [0.7, 0, 0])  # as its neighbours
        self.assertEqual(found[2, 3].tolist(), [0.7, 0, 0])  # as a neighbour, across the corner
        self.assertEqual(found[4, 5].tolist(), [1, 1, 1])
        self.assertAlmostEqual(found[4, 0, 0], 0.14)
        self.assertEqual(numpy.count_nonzero(found.sum(axis=2)), 4)

    def test_the_signal_to_noise_ratio_of_a_tenth_is_20_db(self):
        self.assertAlmostEqual(pictures.psnr(0.01), 20)
        picture = numpy.full((2, 2, 3), 3.0)
        self.assertEqual(pictures.square(picture, picture, 0.1).max(), 0)
        self.assertAlmostEqual(pictures.exposure(picture), 0.06)
        self.assertAlmostEqual(float(pictures.shown(numpy.array(1.0), 1)), 0.5 ** (1 / 2.2))

    def test_other_depths_differ_by_more_than_a_twentieth(self):
        should = numpy.array([10, 10, 1e10, 0], numpy.float32)
        is_ = numpy.array([10.4, 9.4, 1e10, 0], numpy.float32)
        self.assertEqual(pictures.other_depth(is_, should).tolist(), [False, True, False, False])


class Views(unittest.TestCase):
    TEXT = "rview -vtv -vp 1 2 3 -vd 0 1 0 -vu 0 0 1 -vh 90 -vv 60 -vs 0.25 -vl 0"

    def test_views_are_read_and_written(self):
        view = views.parse(self.TEXT)
        self.assertEqual(view["-vp"], [1, 2, 3])
        self.assertEqual(view["-vv"], [60])
        self.assertEqual(views.parse(" ".join(views.words_of(view))), view)
        with self.assertRaises(ValueError):
            views.parse("-vtv -vq 3")
        with self.assertRaises(ValueError):
            views.parse("-vp 1 2")

    def test_rays_go_through_the_middles_of_pixels(self):
        view = views.parse("-vtv -vp 1 2 3 -vd 0 2 0 -vu 0 0 1 -vh 90 -vv 90 -vo 0.5")
        origins, along = views.rays(view, 3, 3)
        numpy.testing.assert_allclose(along[1, 1], [0, 1, 0], atol=1e-12)
        numpy.testing.assert_allclose(origins[1, 1], [1, 2.5, 3], atol=1e-12)
        third = 2 / 3
        numpy.testing.assert_allclose(along[0, 2], views.unit(numpy.array([third, 1, third])), atol=1e-12)
        numpy.testing.assert_allclose(along[2, 0], views.unit(numpy.array([-third, 1, -third])), atol=1e-12)
        with self.assertRaises(ValueError):
            views.rays(views.parse("-vth"), 2, 2)

    def test_a_view_shifted_by_a_pixel_has_the_rays_of_the_pixel_beside(self):
        view = views.parse(self.TEXT)
        _, along = views.rays(view, 8, 6)
        _, moved = views.rays(views.shifted(view, 1 / 8, 1 / 6), 8, 6)
        numpy.testing.assert_allclose(moved[1:, :-1], along[:-1, 1:], atol=1e-12)


class Moves(unittest.TestCase):
    def test_a_walk_sideways_crosses_in_the_middle_where_it_can(self):
        self.assertEqual(moves.crossing(50, 0.2, 100, 100), 25)
        for left, right in ((100, 3), (3, 100), (5.5, 5.5), (7.8, 3)):
            begin = moves.crossing(50, 0.2, left, right)
            self.assertLessEqual(begin * 0.2 + 2 * 0.2, left + 1e-9, (left, right))
            self.assertLessEqual((50 - begin) * 0.2 + 2 * 0.2, right + 1e-9, (left, right))
        self.assertIsNone(moves.crossing(50, 0.2, 5, 5))


class Masks(unittest.TestCase):
    def test_names_come_in_rows_and_are_chosen(self):
        names = regions.names_of("floor\nglass\t\n*\nglass_2\nglass\nfloor\n", (2, 3))
        self.assertEqual(names[1].tolist(), ["glass_2", "glass", "floor"])
        self.assertEqual(regions.mask(names, ("glass",)).tolist(), [[False, True, False], [False, True, False]])
        self.assertEqual(regions.mask(names, ("glass", "floor")).sum(), 4)
        with self.assertRaises(ValueError):
            regions.names_of("floor\n", (2, 3))


class Summaries(unittest.TestCase):
    def test_excess_and_worst(self):
        errors = [truth.FrameError(off=5, floor=6, beyond=1, square=0.01, floor_square=0.1, error=2),
                  truth.FrameError(off=9, floor=6, beyond=3, square=0.001, floor_square=0.1, error=4)]
        found = truth.summary(errors)
        self.assertEqual((found["off"], found["excess"], found["worst excess"]), (7, 1, 3))
        self.assertEqual((found["beyond"], found["worst beyond"], found["error"]), (2, 3, 3))
        self.assertAlmostEqual(found["worst PSNR"], 20)
        self.assertAlmostEqual(found["floor PSNR"], 10)

    def test_pixels_that_lie_elsewhere_do_not_count_as_reused(self):
        def frame(reused, traced):
            return {"reused": reused, "traced": {"uncovered": traced, "audited": 10}}

        stats = {"picture": {"width": 10, "height": 20},
                 "reuse": {"frames": [frame(0, 190), frame(180, 20), frame(100, 100)]}}
        errors = [truth.FrameError(0, 0, 0, 0, 0, 0, elsewhere=share) for share in (5, 60)]
        self.assertAlmostEqual(truth.passing(stats, errors), (85 + 0) / 2)
        self.assertAlmostEqual(stage.traced_share(stats), (200 + 30 + 110) / 200)

    def test_traced_pictures_are_taken_only_by_the_walk_and_program_that_made_them(self):
        with tempfile.TemporaryDirectory() as scratch:
            folder = pathlib.Path(scratch)
            program = folder / "program"
            program.write_text("1")
            place = types.SimpleNamespace(program=types.SimpleNamespace(lightwalk=program))

            def walk(text="-vp 1 2 3", width=64):
                return truth.TracedWalk(place, stage.Size(1, width, 48, 0), [views.parse(text)], folder)

            self.assertFalse(walk().left_before())
            made = {"seconds": 1.5, "shape": [47, 64]}
            (folder / "traced.json").write_text(json.dumps(walk().made_from() | made))
            found = walk()
            with contextlib.redirect_stderr(io.StringIO()):
                self.assertTrue(found.left_before())
            self.assertEqual((found.seconds, found.shape), (1.5, (47, 64)))
            self.assertFalse(walk("-vp 1 2 4").left_before())
            self.assertFalse(walk(width=65).left_before())
            program.write_text("12")
            self.assertFalse(walk().left_before())

    def test_rules_are_settings_of_options(self):
        found = ways.rules("near,drop")
        self.assertEqual(found["near 0"], "--near 0 --audit-limit 0")
        self.assertEqual(found["drop hidden"], "--check none --drop hidden --audit-limit 0")
        self.assertEqual(found["defaults"], "")
        self.assertNotIn("check all", found)
        self.assertLessEqual(set(found), set(ways.rules("all")))
        with self.assertRaises(SystemExit):
            ways.rules("nearness")
        self.assertEqual(ways.given(["a b=--near 1", "c="]), {"a b": "--near 1", "c": ""})


class KeyFrames(unittest.TestCase):
    def test_they_are_spread_and_no_fewer_than_were_traced(self):
        self.assertEqual(interpolated.keys(50, 1.2), [1, 50])
        self.assertEqual(interpolated.keys(51, 2.1), [1, 26, 51])
        self.assertEqual(interpolated.keys(5, 80), [1, 2, 3, 4, 5])
        for traced in (2.5, 3, 7.3, 20):
            found = interpolated.keys(50, traced)
            self.assertGreaterEqual(len(found), traced)
            steps = numpy.diff(found)
            self.assertLessEqual(steps.max() - steps.min(), 1)
        self.assertEqual(interpolated.neighbours(30, [1, 26, 51]), (26, 51))


if __name__ == "__main__":
    unittest.main()
