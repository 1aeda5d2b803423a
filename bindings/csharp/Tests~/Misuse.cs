using System;
using System.Collections.Generic;
using System.Threading;

namespace Voxtet.Tests
{
    /// <summary>What a user may do wrong, and what threads may do at once.</summary>
    static class Misuse
    {
        static readonly uint[] tet = { 0, 1, 2, 3 };
        static readonly float[] unit = { 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1 };

        /// <summary>A block of n^3 cubes with edge 1, five tetrahedra each, from x on.</summary>
        static void Block(uint n, float x, out float[] positions, out uint[] tets)
        {
            uint m = n + 1;
            var p = new List<float>();
            var t = new List<uint>();
            for (uint v = 0; v < m * m * m; ++v) p.AddRange(new[] { x + v % m, v / m % m, (float)(v / m / m) });
            uint[][] cuts =
            {
                new uint[] { 0, 1, 2, 4, 3, 2, 1, 7, 5, 4, 7, 1, 6, 7, 4, 2, 1, 2, 4, 7 },
                new uint[] { 1, 3, 0, 5, 2, 0, 3, 6, 4, 6, 5, 0, 7, 5, 6, 3, 0, 5, 3, 6 }
            };
            for (uint c = 0; c < n * n * n; ++c)
            {
                uint i = c % n, j = c / n % n, k = c / n / n;
                foreach (uint d in cuts[(i + j + k) % 2])
                    t.Add(i + (d & 1) + m * (j + (d >> 1 & 1)) + m * m * (k + (d >> 2)));
            }
            positions = p.ToArray();
            tets = t.ToArray();
        }

        static Grid TwoBlocks(out Body a, out Body b, GridOptions options = null, uint n = 6)
        {
            var grid = new Grid(options ?? new GridOptions());
            float[] positions;
            uint[] tets;
            Block(n, 0, out positions, out tets);
            a = grid.Add(positions, tets);
            Block(n, n / 2f + 0.3f, out positions, out tets);
            b = grid.Add(positions, tets);
            return grid;
        }

        static void Put(Grid grid, Body mesh, int index, float number)
        {
            Positions<float> positions = grid.GetPositions(mesh);
            positions[index] = number;
        }

        public static void Errors()
        {
            var grid = new Grid();
            Body mesh = grid.Add(unit, tet);
            Test.Throws<VoxArgumentException>(() => grid.Add(unit, new uint[] { 0, 1, 2, 4 }), "names vertex 4 of 4");
            Test.Throws<ArgumentException>(() => grid.Add(unit, new uint[] { 0, 1, 2 }), "3 numbers, expected 4");
            Test.Throws<ArgumentException>(() => grid.Add(new float[4], tet), "4 numbers, expected 3");
            Test.Throws<VoxException>(() => grid.Add(unit, tet, 0, default(Filter), new float[3]), "rest_positions.count is 1, expected 4");
            Test.Throws<VoxArgumentException>(() => new Grid(new GridOptions { CellSize = -1 }), "cell_size is -1");
            Test.Throws<VoxException>(() => new Grid(new GridOptions { ByteBudget = 10 }), "budget is 10");
            Test.Throws<VoxException>(() => new Grid(new GridOptions { Reference = new ReferenceOptions { HashTableSize = ulong.MaxValue } }),
                                      "hash_table_size");
            Test.Throws<ArgumentNullException>(() => new Grid(null), "");
            Test.Throws<VoxArgumentException>(() => Grid.Load(new byte[5]), "snapshot");
            Test.Throws<VoxArgumentException>(() => Grid.Load(new byte[0]), "snapshot");
            Test.Throws<ArgumentException>(() => grid.GetDoublePositions(mesh), "are Float, asked for as Double");
            Test.Throws<ArgumentException>(() => grid.GetPositions(mesh).Set(new float[3]), "3 numbers, expected 12");
            Test.Throws<IndexOutOfRangeException>(() => Put(grid, mesh, 12, 0), "");
            Test.Throws<VoxException>(() => { var c = grid.Constraints; }, "VOX_GRID_CONSTRAINTS");
            Test.Throws<VoxException>(() => grid.FindConstraints(), "call vox_grid_step first");
            Test.Throws<VoxArgumentException>(() => grid.Margin = -1, "margin is -1");
            Test.Throws<VoxArgumentException>(() => grid.SetPreviousPositions(mesh, new float[6]), "positions.count is 2, expected 4");
            Test.Throws<ArgumentException>(() => grid.SetTransform(mesh, new double[3]), "3 numbers, expected 12");
            Test.Throws<ArgumentException>(() => grid.ReplaceTets(mesh, new uint[1], new uint[3]), "3 corners, expected 4");
            Put(grid, mesh, 5, float.NaN);
            Test.Throws<VoxException>(() => grid.Step(), "vertex 1");
            Test.Same(grid.GetFailure().body, mesh.Id, "failure");
            Put(grid, mesh, 5, 0);
            grid.Step();
            grid.Remove(mesh);
            Test.Throws<VoxException>(() => grid.Remove(mesh), "stale");
            Test.Throws<VoxException>(() => grid.GetFacts(mesh), "stale");
            Test.That(!grid.Contains(mesh), "a removed mesh");
            grid.Dispose();
            grid.Dispose();
            Test.Throws<ObjectDisposedException>(() => grid.Step(), "");
            Test.Throws<ObjectDisposedException>(() => { ulong hash = grid.Hash; }, "");
        }

        /// <summary>The paper's engine finds the same, and a sensor has contacts without constraints.</summary>
        public static void Settings()
        {
            Body a, b;
            var options = new GridOptions { Reference = new ReferenceOptions { Flags = ReferenceFlags.Dense }, ByteBudget = ulong.MaxValue };
            using (Grid fast = TwoBlocks(out a, out b), paper = TwoBlocks(out a, out b, options))
            {
                paper.Step();
                fast.SetFilter(a, new Filter { flags = FilterFlags.Sensor });
                fast.Step();
                Test.Same(fast.Hash, paper.Hash, "hash");
                fast.FindConstraints();
                paper.FindConstraints();
                Test.That(fast.Constraints.Length == 0 && paper.Constraints.Length > 0, "constraints");
                Test.That(fast.GetFilter(a).flags == FilterFlags.Sensor && fast.GetFilter(b).mask == ulong.MaxValue, "filters");
            }
        }

        public static void Views()
        {
            Body a, b;
            Grid grid = TwoBlocks(out a, out b);
            grid.Step();
            View<Contact> contacts = grid.Contacts;
            int count = contacts.Length;
            Test.That(count > 100, "contacts: " + count);
            Contact[] kept = contacts.ToArray();
            Pair pair = grid.Pairs[0];
            Test.That(pair.state == PairState.Began && pair.contact_count == (ulong)count, "a pair that began");
            Test.Same(grid.PairContacts.Slice((int)pair.first_contact, count).Length, count, "contacts of a pair");
            Test.That(Grid.LibraryBuild.Contains(Grid.LibraryVersion), Grid.LibraryBuild);
            string end = "";
            int read = 0;
            try
            {
                foreach (Contact contact in grid.Contacts)
                {
                    Test.Same(contact.vertex, kept[read].vertex, "vertex of contact " + read);
                    if (++read == 2) grid.Step();
                }
            }
            catch (InvalidOperationException error) { end = error.Message; }
            Test.That(end.Contains("this view ended") && read == 2, read + " contacts read; " + end);
            try { foreach (Contact contact in contacts) ++read; } catch (InvalidOperationException) { read = -1; }
            Test.Same(read, -1, "contacts read of a view that ended");
            Positions<float> positions = grid.GetPositions(b);
            for (int i = 0; i < positions.Length; i += 3) positions[i] += 100;
            grid.Step();
            try { count = contacts.Length; } catch (InvalidOperationException error) { end = error.Message; }
            Test.That(end.Contains("this view ended"), end);
            try { end = ""; kept[0] = contacts[0]; } catch (InvalidOperationException error) { end = error.Message; }
            Test.That(end.Contains("this view ended"), end);
            Test.Same(grid.Contacts.Length, 0, "contacts");
            Test.Same(grid.Pairs[0].state, PairState.Ended, "a pair");
            positions[0] = 0; // still there after a step
            grid.Remove(b);
            try { end = ""; positions[0] = 1; } catch (InvalidOperationException error) { end = error.Message; }
            Test.That(end.Contains("these positions ended"), end);
            View<Contact> last = grid.Contacts;
            grid.Dispose();
            try { end = ""; count = last.Length; } catch (InvalidOperationException error) { end = error.Message; }
            Test.That(end.Contains("this view ended"), end);
            Test.Same(kept[0].body_a, a.Id, "a copy");
        }

        static double Gap(Constraint c, double[] a, double[] b)
        {
            double gap = c.offset;
            for (int i = 0; i < c.count; ++i)
                for (int k = 0; k < 3; ++k)
                    gap += c.weights[i] * c.normal[k] * (i < c.count_a ? a : b)[3 * c.vertices[i] + k];
            return gap;
        }

        /// <summary>Each kind, where it is expected, and what it says of the positions.</summary>
        public static void Constraints()
        {
            Body a, b;
            Grid grid = TwoBlocks(out a, out b, new GridOptions { Flags = GridFlags.Constraints | GridFlags.Edges, Margin = 0.8 });
            double[] atA = Array.ConvertAll(grid.GetPositions(a).ToArray(), x => (double)x);
            double[] atB = Array.ConvertAll(grid.GetPositions(b).ToArray(), x => (double)x);
            grid.Step();
            var kinds = new int[4];
            foreach (Constraint c in grid.Constraints)
            {
                ++kinds[(int)c.kind];
                double gap = c.body_a == a.Id ? Gap(c, atA, atB) : Gap(c, atB, atA);
                Test.That(Math.Abs(gap - c.gap) < 1e-9, c.kind + ": its gap is " + c.gap + ", expected " + gap);
                Test.That(c.gap >= 0 == (c.kind == ConstraintKind.Proximity) || c.gap == 0, c.kind + ": its gap is " + c.gap);
            }
            Test.That(kinds[0] > 0 && kinds[1] > 0 && kinds[2] > 0 && kinds[3] == 0, string.Join(" ", kinds));
            Test.Same(grid.ConstraintsOf(0).Length, grid.Constraints.Length, "constraints of the only pair");
            View<Constraint> before = grid.Constraints;
            grid.FindConstraints(DepthMethod.None, b, a);
            string end = "";
            try { int count = before.Length; } catch (InvalidOperationException error) { end = error.Message; }
            Test.That(end.Contains("this view ended"), end);
            Test.Same(grid.Constraints[0].state, DepthState.Unknown, "state");
            grid.FindConstraints(DepthMethod.Closest, closestBudget: 1);
            int searched = 0;
            foreach (Constraint c in grid.Constraints)
                if (c.kind == ConstraintKind.Inside && c.state != DepthState.Unknown) ++searched;
            Test.Same(searched, 1, "constraints within the budget");
            grid.FindConstraints(mask: 2);
            Test.Same(grid.Constraints.Length + grid.ConstraintsOf(0).Length, 0, "constraints of no category");
            Test.Throws<VoxException>(() => grid.FindConstraints(b: a), "there is no body_a");
            grid.Remove(b);
            Test.Throws<VoxException>(() => grid.FindConstraints(), "was removed since the step");
            grid.Dispose();
        }

        /// <summary>A vertex that went through a mesh within the step, until its mesh stands still.</summary>
        public static void PreviousPositions()
        {
            using (var grid = new Grid())
            {
                grid.Add(unit, tet);
                float[] past = { 0.2f, 0.2f, -0.1f };
                Body point = grid.Add(past, new uint[0]);
                var before = new double[] { 0.2, 0.2, 3 };
                grid.SetPreviousPositions(point, before);
                before[2] = -9; // copied
                for (int i = 0; i < 2; ++i)
                {
                    grid.Step();
                    grid.FindConstraints();
                    Test.Same(grid.Constraints[0].kind, ConstraintKind.Impact, "kind");
                    grid.SetPreviousPositions(point, new[] { 0.2f, 0.2f, 2 });
                }
                Test.Throws<VoxException>(() => grid.SetPreviousPositions(point, new double[6]), "positions.count is 2, expected 1");
                grid.SetPreviousPositions(point, new float[0]);
                grid.Step();
                grid.FindConstraints();
                Test.Same(grid.Constraints.Length, 0, "constraints of what stands still");
                grid.SetPreviousPositions(point, past);
                grid.Remove(point);
                grid.Step();
                Test.Throws<VoxException>(() => grid.SetPreviousPositions(point, past), "stale");
                grid.SetPreviousPositions(grid.Add(past, new uint[0]), past);
                grid.Clear();
                grid.Step();
            }
        }

        public static void Threads()
        {
            Body a, b;
            Grid grid = TwoBlocks(out a, out b, new GridOptions { Workers = Grid.AllCores }, 12);
            grid.Step();
            ulong hash = grid.Hash;
            int refused = 0, wrong = 0;
            var threads = new Thread[4];
            for (int t = 0; t < threads.Length; ++t)
            {
                threads[t] = new Thread(() =>
                {
                    for (int i = 0; i < 200; ++i)
                        try
                        {
                            grid.MarkMoved(a);
                            grid.Step();
                            if (grid.Hash != hash) Interlocked.Increment(ref wrong);
                        }
                        catch (InvalidOperationException)
                        {
                            Interlocked.Increment(ref refused);
                        }
                        catch (Exception)
                        {
                            Interlocked.Increment(ref wrong);
                        }
                });
                threads[t].Start();
            }
            foreach (Thread thread in threads) thread.Join();
            Test.Same(wrong, 0, "wrong results");
            grid.Step();
            Test.Same(grid.Hash, hash, "after " + refused + " refused calls");
            Test.Same(grid.Counters["contacts"], (ulong)grid.Contacts.Length, "counters");
            // A locator is asked while the grid steps and goes.
            Locator locator = grid.TakeLocator();
            int found = 0;
            var asking = new Thread(() =>
            {
                var hits = new PointHit[8];
                for (int i = 0; i < 500; ++i) found += (int)locator.FindPointHits(new[] { 7.5, 5.25, 3.125 }, hits);
            });
            asking.Start();
            for (int i = 0; i < 10; ++i)
            {
                grid.MarkMoved(a);
                grid.Step();
            }
            grid.Dispose();
            asking.Join();
            Test.Same(found, 1000, "hits of a locator");
            locator.Dispose();
            Test.Throws<ObjectDisposedException>(() => { ulong epoch = locator.Epoch; }, "");
            Test.Throws<ObjectDisposedException>(() => grid.TakeLocator(), "");
        }

        public static void Locators()
        {
            Body a, b;
            Grid grid = TwoBlocks(out a, out b);
            Locator locator = grid.TakeLocator();
            double[] from = { -1, 0.5, 0.5, -1, 9, 0 }, to = { 9, 0.5, 0.5, 9, 9, 0 }, point = { -1, 0.5, 0.5 };
            var hits = new RayHit[9];
            var blocked = new byte[2];
            var closest = new ClosestHit[1];
            ulong all = locator.FindRayHits(from, to, hits);
            Test.That(all > 2 && hits[0].body == a.Id && hits[0].ray == 0, all + " hits");
            Test.Same(locator.FindRayHits(from, to, new RayHit[0]), all, "hits");
            Test.Same(locator.FindRayHits(from, to, hits, new QueryDesc { flags = QueryFlags.FirstHit }), 1ul, "first hits");
            locator.FindRayHits(from, to, hits, new QueryDesc { excluded = a.Id });
            Test.Same(hits[0].body, b.Id, "body of a hit");
            locator.TestRays(from, to, blocked);
            Test.That(blocked[0] == 1 && blocked[1] == 0, "blocked rays");
            locator.TestRays(from, to, blocked, new QueryDesc { mask = 2 });
            Test.Same(blocked[0], (byte)0, "a ray that all pass");
            var location = new Location[1];
            locator.Locate(point, location);
            Test.That(location[0].body == a.Id && location[0].state == LocationState.Outside, "a location outside");
            Test.Same(location[0].distance, 1.0, "distance of a location");
            locator.Locate(point, location, new QueryDesc { max_distance = 0.5 });
            Test.Same(location[0].state, LocationState.None, "a location too far away");
            var pieces = new TrackPiece[99];
            ulong tracks = locator.FindTracks(from, to, pieces, new QueryDesc { excluded = b.Id });
            Test.That(tracks > 2 && pieces[0].t_out == pieces[1].t_in, tracks + " pieces");
            var axes = new ClosestHit[2];
            locator.FindClosestToSegments(from, to, axes);
            Test.That(axes[0].distance == 0 && axes[1].distance > 0, "closest to segments");
            var blade = new[] { from[0], from[1], from[2], to[0], to[1], to[2], to[0], to[1], to[2] };
            var tip = new[] { from[0], from[1], from[2], from[0], from[1], from[2], from[0], from[1], from[2] };
            var cut = new TriangleHit[999];
            ulong still = locator.FindTriangleHits(blade, new double[0], cut);
            Test.That(still > 2 && cut[0].t == 0, still + " tetrahedra of a blade");
            Test.That(locator.FindTriangleHits(tip, blade, cut) > 2 && cut[0].t > 0, "a moving blade");
            Test.Throws<ArgumentException>(() => locator.Locate(from, location), "room for 1, expected 2");
            locator.FindClosest(point, closest, new QueryDesc { max_distance = 0.5 });
            Test.Same(closest[0].body, 0u, "nothing is near");
            locator.FindClosest(point, closest);
            Test.Same(closest[0].distance, 1.0, "distance");
            Test.Throws<ArgumentException>(() => locator.FindPointHits(new double[4], new PointHit[1]), "4 numbers, expected 3");
            Test.Throws<ArgumentException>(() => locator.FindClosest(from, closest), "room for 1, expected 2");
            Test.Throws<ArgumentException>(() => locator.TestRays(from, to, new byte[1]), "room for 1, expected 2");
            Test.Throws<VoxException>(() => locator.TestRays(from, point, blocked), "from.count is 2, to.count is 1");
            Test.Throws<VoxException>(() => locator.FindClosest(point, closest, new QueryDesc { max_distance = -1 }), "max_distance is -1");
            Test.Throws<ArgumentNullException>(() => locator.Update(null), "grid");
            ulong epoch = locator.Epoch;
            Put(grid, a, 0, float.NaN);
            Test.Throws<VoxException>(() => locator.Update(grid), "vertex 0");
            Test.Same(locator.Epoch, epoch, "the epoch stays");
            grid.Remove(a);
            Test.Same(locator.GetUserData(a), 0ul, "user data");
            grid.Step();
            locator.Update(grid);
            Test.That(locator.Epoch > epoch, "the epoch of another moment");
            Test.Throws<VoxException>(() => locator.GetUserData(a), "");
            locator.Dispose();
            Test.Throws<ObjectDisposedException>(() => locator.Update(grid), "");
            grid.Dispose();
        }

        public static void Log()
        {
            var lines = new List<string>();
            Grid grid = null;
            grid = new Grid(new GridOptions
            {
                Log = (level, text) =>
                {
                    lines.Add(level + " " + text);
                    try { grid.Step(); } catch (InvalidOperationException) { lines.Add("refused"); }
                    throw new Exception("of a log");
                }
            });
            GC.Collect();
            grid.Add(unit, new uint[0]); // edges and faces collide with nothing
            Test.Same(lines.Count, 2, "lines");
            Test.That(lines[0].StartsWith("Warning "), lines[0]);
            Test.Same(lines[1], "refused", "a call of the grid from its log");
            grid.Dispose();
        }

        static double ThrowingCost(double cellSize) { throw new FormatException("of a cost"); }

        public static void CellSizes()
        {
            float[] positions;
            uint[] tets;
            Block(5, 0, out positions, out tets);
            Suggestion suggestion = CellSize.Suggest(positions, tets);
            Test.That(suggestion.ZoneMin < suggestion.CellSize && suggestion.CellSize < suggestion.ZoneMax, "the zone");
            Test.That(suggestion.Curve[1].cell_size > suggestion.Curve[0].cell_size, "the curve");
            Geometry geometry = CellSize.MeasureGeometry(new[] { positions, positions }, new[] { tets, tets });
            Test.Same(geometry.tets, (ulong)tets.Length / 2, "tets");
            Test.That(geometry.mean_edge > 0 && geometry.bounds_min.x < geometry.bounds_max.x, "lengths");
            Test.Throws<VoxArgumentException>(() => CellSize.MeasureGeometry(new[] { unit }, new[] { new uint[] { 0, 1, 2, 9 } }), "");
            Test.Throws<ArgumentException>(() => CellSize.Suggest(new float[1][], new uint[2][]), "2 arrays of tets");
            Test.Throws<ArgumentNullException>(() => CellSize.Suggest(new float[1][], new uint[1][]), "mesh 0");
            Test.Throws<VoxArgumentException>(() => CellSize.Suggest(unit, new uint[0]), "");
            Suggestion least = CellSize.Minimise(x => (x - 2) * (x - 2) + 1, 0.1, 10);
            Test.That(Math.Abs(least.CellSize - 2) < 1e-3 && Math.Abs(least.Cost - 1) < 1e-6, "least at " + least.CellSize);
            Test.Throws<FormatException>(() => CellSize.Minimise(x => { throw new FormatException("of a cost"); }, 0.1, 10),
                                         "of a cost");
            try
            {
                CellSize.Minimise(ThrowingCost, 0.1, 10);
            }
            catch (FormatException error)
            {
                Test.That(error.StackTrace.Contains("ThrowingCost"), "where it was thrown: " + error.StackTrace);
            }
            Test.Throws<VoxArgumentException>(() => CellSize.Minimise(x => x, 2, 1), "");
            CostWeights weights = CellSize.Calibrate(), twice = weights;
            for (int i = 0; i < Double24.Length; ++i) twice.ns[i] *= 2;
            Test.Same(CellSize.Suggest(positions, tets, CostModel.Reference, twice).Cost,
                      2 * CellSize.Suggest(positions, tets, CostModel.Reference, weights).Cost, "weights");
            Body a, b;
            using (Grid grid = TwoBlocks(out a, out b))
                Test.That(grid.SuggestCellSize().CellSize > 0 && grid.SuggestCellSize(CostModel.Paper).CellSize > 0, "a grid");
            using (Grid grid = TwoBlocks(out a, out b, new GridOptions { Reference = new ReferenceOptions { Weights = weights } }))
            {
                Test.Same(grid.SuggestCellSize(CostModel.Reference, twice).Cost, 2 * grid.SuggestCellSize().Cost,
                          "weights of a grid");
                Test.Throws<ArgumentException>(() => grid.SuggestCellSize(null, weights), "need a model");
            }
            twice.ns[2] = -1;
            Test.Throws<VoxArgumentException>(() => CellSize.Suggest(unit, tet, CostModel.Fast, twice), "weights.ns[2] is -1");
        }

        public static void GridsOfOthers()
        {
            float[] positions;
            uint[] tets;
            Block(4, 0, out positions, out tets);
            var stored = new PrimitiveArrays(PrimitiveType.Tet, positions, tets);
            var querying = new PrimitiveArrays(PrimitiveType.Point, Array.ConvertAll(positions, x => (double)x)) { Radius = 0.2 };
            var grid = new GridDescription(stored, KnownGrid.Hashed) { Querying = querying };
            Suggestion suggestion = CellSize.Suggest(grid);
            Test.That(suggestion.ZoneMin <= suggestion.CellSize && suggestion.CellSize <= suggestion.ZoneMax, "the zone");
            Test.That(suggestion.Terms[0].Name.Length > 0 && suggestion.Rules[0].Name.Length > 0, "names");
            double sum = 0;
            foreach (Suggestion.Term term in suggestion.Terms) sum += term.Cost;
            Test.That(Math.Abs(sum - suggestion.Cost) <= 1e-9 * sum, "terms");
            Test.That((suggestion.Note == "") == (suggestion.Warnings == 0), "note");
            Suggestion unknown = CellSize.Suggest(new GridDescription(stored));
            Test.That((unknown.Warnings & CellSizeWarnings.GuessedWeights) != 0 && unknown.Note != "", "a warning");

            // A grid that takes as long as its counts say.
            Func<double, double> seconds = d =>
            {
                ForeignCounts counts = CellSize.Count(grid, d);
                return 1e-9 * (20 * counts.stored + 9 * counts.visits + 3 * counts.reads);
            };
            Timing[] timings = Array.ConvertAll(new[] { 0.3, 0.6, 1.2, 2.4 },
                                                d => new Timing { cell_size = d, seconds = seconds(d) });
            Suggestion fit = CellSize.Fit(grid, timings);
            Test.That(fit.FitError < 0.02 && fit.Weights.store > 0, "fit error " + fit.FitError);
            grid.Weights = fit.Weights;
            Test.Same(CellSize.Suggest(grid).Weights.store, fit.Weights.store, "weights");
            int runs = 0;
            Suggestion tuning = CellSize.Tune(d => { ++runs; return seconds(d); }, grid);
            Test.Same(tuning.Timings.Length, runs, "runs");
            Test.That(tuning.ExpectedLoss < 0.1, "expected loss " + tuning.ExpectedLoss);
            Test.That(seconds(tuning.CellSize) <= 1.1 * seconds(fit.CellSize), "tuned to " + tuning.CellSize);

            runs = 0;
            Test.Throws<FormatException>(() => CellSize.Tune(d => { ++runs; throw new FormatException("of a run"); }, grid), "of a run");
            Test.Same(runs, 1, "runs");
            Test.Throws<VoxArgumentException>(() => CellSize.Tune(d => 1), "desc.first is 0");
            Test.Throws<VoxArgumentException>(() => CellSize.Fit(grid, timings[0]), "expected at least 3");
            Test.Throws<VoxArgumentException>(() => CellSize.Count(grid, 0), "cell_size is 0");
            Test.Throws<ArgumentNullException>(() => CellSize.Suggest((GridDescription)null), "grid");
            Test.Throws<ArgumentNullException>(() => new GridDescription(null), "stored");
            Test.Throws<ArgumentException>(() => new PrimitiveArrays(PrimitiveType.Triangle, positions, new uint[4]),
                                           "4 vertices, expected 3 for each");
            Test.Throws<ArgumentException>(() => new PrimitiveArrays(PrimitiveType.Point, new float[4]), "4 numbers");
            querying.Radii = new double[3];
            Test.Throws<ArgumentException>(() => CellSize.Suggest(grid), "3 radii, expected");
            Test.Throws<VoxArgumentException>(() => CellSize.Suggest(new GridDescription(stored, (KnownGrid)99)), "known is 99");
            var wrong = new PrimitiveArrays(PrimitiveType.Edge, positions, new uint[] { 0, 9999 });
            Test.Throws<VoxArgumentException>(() => CellSize.Suggest(new GridDescription(wrong)), "names vertex 9999");
        }

        public static void Files()
        {
            string folder = System.IO.Path.Combine(System.IO.Path.GetTempPath(), "voxtet-" + Guid.NewGuid());
            System.IO.Directory.CreateDirectory(folder);
            string path = System.IO.Path.Combine(folder, "bälle.msh");
            try
            {
                using (MeshFile ball = MeshFile.Ball(1, 0.3))
                {
                    ball.Save(path);
                    using (MeshFile read = MeshFile.Load(path))
                    {
                        Test.Same(read.GetTets().Length, ball.GetTets().Length, "tets");
                        Test.Same(read.GetPositions()[7], ball.GetPositions()[7], "positions");
                        Test.Same(read.Warnings, "", "warnings");
                        Test.Same(read.Report.inverted_tets, 0ul, "inverted tets");
                        Test.Same(read.GetTriangles().Length % 3, 0, "triangles");
                    }
                }
                Test.Throws<VoxArgumentException>(() => MeshFile.Read("a.msh", new byte[] { 36, 77 }), "a.msh");
            }
            finally
            {
                System.IO.Directory.Delete(folder, true);
            }
            Test.Throws<VoxException>(() => MeshFile.Load(path), "bälle.msh");
            Test.Throws<ArgumentException>(() => MeshFile.Load("a\0b"), "zero character");
            Test.Throws<VoxArgumentException>(() => MeshFile.Ball(-1, 0.1), "");
            uint[] facets = { 0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3 };
            using (MeshFile surface = MeshFile.Create(Array.ConvertAll(unit, x => (double)x), null, facets))
            using (MeshFile filled = surface.Tetrahedralize(0.1, 0.03))
                Test.That(filled.GetQuality(surface).hausdorff <= 0.03 && filled.GetQuality().hausdorff == 0, "distances");
            Test.Throws<ArgumentException>(() => MeshFile.Create(new double[4], null, null), "3 numbers a vertex");
            Test.Throws<VoxArgumentException>(() => MeshFile.Create(new double[3], new uint[4] { 0, 1, 2, 3 }, null), "");
            using (MeshFile torus = MeshFile.Torus(1, 0.3, 0.1)) Test.That(torus.Report.volume > 1.5, "a torus");
        }

        public static void ManyGrids()
        {
            var grids = new Grid[20];
            Body a = Body.None, b;
            for (int i = 0; i < grids.Length; ++i) grids[i] = TwoBlocks(out a, out b);
            Grid.StepAll(grids, 2);
            foreach (Grid grid in grids) Test.Same(grid.Hash, grids[0].Hash, "hash");
            Put(grids[7], a, 9, float.PositiveInfinity);
            Test.Throws<VoxException>(() => Grid.StepAll(grids), "grid 7: ");
            Test.That(grids[8].Contacts.Length > 100, "the others are stepped");
            Test.Throws<InvalidOperationException>(() => Grid.StepAll(new[] { grids[0], grids[0] }), "");
            Test.Throws<ArgumentNullException>(() => Grid.StepAll(new Grid[1]), "grids[0]");
            Grid.StepAll(new Grid[0]);
            foreach (Grid grid in grids) grid.Dispose();
        }

        public static void EmptyArrays()
        {
            using (var grid = new Grid())
            {
                Body mesh = grid.Add(new float[0], new uint[0]);
                Test.Same(grid.GetPositions(mesh).Length, 0, "positions");
                grid.Step();
                using (Locator locator = grid.TakeLocator())
                {
                    Test.Same(locator.FindPointHits(new double[0], new PointHit[0]), 0ul, "hits");
                    locator.FindClosest(new double[0], new ClosestHit[0]);
                }
                Test.Same(grid.AppendVertices(mesh, unit), 0u, "first vertex");
                Test.Same(grid.AppendTets(mesh, tet), 0u, "first tet");
                Test.Same(grid.GetPositions(mesh)[3], 1f, "positions");
                foreach (Contact contact in grid.Contacts) Test.That(false, "a contact of " + contact.vertex);
                grid.Step();
                grid.FindConstraints();
                Test.Same(grid.Constraints.Length + (int)grid.PairOffsets[0], 0, "constraints");
            }
        }

        /// <summary>Calls with arguments at random: each succeeds or throws, and the grid still steps.</summary>
        public static void AnythingGoes()
        {
            var random = new Random(1);
            Body a, b;
            Grid grid = TwoBlocks(out a, out b);
            Locator locator = grid.TakeLocator();
            int refused = 0, done = 0;
            for (int round = 0; round < 3000; ++round)
            {
                Body[] meshes = grid.GetBodies();
                Body mesh = random.Next(4) == 0 || meshes.Length == 0 ? new Body((uint)random.Next()) : meshes[random.Next(meshes.Length)];
                var list = new uint[random.Next(4)];
                for (int i = 0; i < list.Length; ++i) list[i] = (uint)random.Next(1500);
                var corners = new uint[4 * list.Length];
                for (int i = 0; i < corners.Length; ++i) corners[i] = (uint)random.Next(345);
                double number = new[] { 0, 1.5, -2, 1e300, double.NaN, double.PositiveInfinity }[random.Next(6)];
                try
                {
                    switch (random.Next(19))
                    {
                        case 0: grid.RemoveTets(mesh, list); break;
                        case 1: grid.SetTetsEnabled(mesh, list, random.Next(2) == 0); break;
                        case 2: grid.ReplaceTets(mesh, list, corners); break;
                        case 3: grid.AppendTets(mesh, corners); break;
                        case 4: grid.AppendCopies(mesh, list); break;
                        case 5: grid.RemoveVertices(mesh, list); break;
                        case 6: grid.SetTransform(mesh, new[] { 1, 0, 0, number, 0, 1, 0, 0, 0, 0, 1, 0 }); break;
                        case 7: grid.CellSize = number; break;
                        case 8: grid.SetPairEnabled(mesh, new Body((uint)random.Next(9000)), random.Next(2) == 0); break;
                        case 9:
                            ulong mask = ulong.MaxValue >> random.Next(64);
                            grid.SetFilter(mesh, new Filter { flags = (FilterFlags)random.Next(5), mask = mask });
                            break;
                        case 10: grid.SetEnabled(mesh, random.Next(2) == 0); break;
                        case 11: grid.Flags = (GridFlags)random.Next(9); break;
                        case 12: if (random.Next(9) == 0) grid.Remove(mesh); break;
                        case 13:
                            float[] positions;
                            uint[] tets;
                            Block(3, random.Next(40) / 10f, out positions, out tets);
                            if (meshes.Length < 4) grid.Add(positions, tets);
                            break;
                        case 14: locator.Update(grid); locator.FindPointHits(new[] { number, 0, 0 }, new PointHit[2]); break;
                        case 15: grid.FindConstraints((DepthMethod)random.Next(4), random.Next(2) == 0 ? mesh : Body.None); break;
                        case 16: grid.SetPreviousPositions(mesh, grid.GetPositions(mesh).AsSpan().Slice(3 * random.Next(2))); break;
                        case 17: grid.Margin = number / 100; break;
                        default: grid.Step(); break;
                    }
                    ++done;
                }
                catch (VoxException error)
                {
                    Test.That(error.Message != "" && error.Code != Result.ErrorInternal, error.ToString());
                    ++refused;
                }
            }
            Test.That(refused > 300 && done > 300, refused + " refused, " + done + " done");
            grid.Dispose();
        }

        /// <summary>A frame takes no memory of the collector's.</summary>
        public static void NoAllocation()
        {
            Body a, b;
            Grid grid = TwoBlocks(out a, out b, new GridOptions { Flags = GridFlags.Constraints });
            double sum = 0;
            Frame(grid, a, ref sum);
            GC.Collect();
            int collections = GC.CollectionCount(0);
            long before = GC.GetTotalMemory(false);
            for (int frame = 0; frame < 2000; ++frame) Frame(grid, a, ref sum);
            Test.That(GC.CollectionCount(0) == collections && GC.GetTotalMemory(false) - before < 20000,
                      "2000 frames took " + (GC.GetTotalMemory(false) - before) + " bytes");
            Test.That(sum > 0, "depths");
            grid.Dispose();
        }

        static void Frame(Grid grid, Body mesh, ref double sum)
        {
            Positions<float> positions = grid.GetPositions(mesh);
            positions[0] = positions[0] > 0 ? 0 : 0.01f;
            grid.Step();
            foreach (Constraint constraint in grid.Constraints) sum -= constraint.gap;
            foreach (Pair pair in grid.Pairs) sum += pair.contact_count;
            sum += grid.Info.moved_bodies;
        }

        static readonly List<WeakReference> forgotten = new List<WeakReference>();

        static void Forget()
        {
            for (int i = 0; i < 50; ++i)
            {
                int lines = 0;
                Grid grid = null;
                grid = new Grid(new GridOptions { Log = (level, text) => lines += grid == null ? 0 : 1 });
                grid.Add(unit, new uint[0]);
                Test.Same(lines, 1, "lines");
                forgotten.Add(new WeakReference(grid));
            }
        }

        /// <summary>A grid whose log holds it, as one that belongs to an object with a field for the grid.</summary>
        public static void LogHoldsGrid()
        {
            var thread = new Thread(Forget); // so that no grid is left on this thread's stack
            thread.Start();
            thread.Join();
            GC.Collect();
            GC.WaitForPendingFinalizers();
            GC.Collect();
            int left = forgotten.FindAll(grid => grid.IsAlive).Count;
            Test.That(left < 5, left + " of " + forgotten.Count + " grids were not collected");
        }

        static long ResidentKilobytes()
        {
            foreach (string line in System.IO.File.ReadAllLines("/proc/self/status"))
                if (line.StartsWith("VmRSS:")) return long.Parse(line.Substring(6).Replace("kB", "").Trim());
            return 0;
        }

        /// <summary>Grids that are disposed of, and grids that are forgotten.</summary>
        public static void NothingLeaks()
        {
            if (!System.IO.File.Exists("/proc/self/status")) return;
            Body a, b;
            long before = 0;
            for (int i = 0; i < 3000; ++i)
            {
                if (i == 1000) before = ResidentKilobytes();
                Grid grid = TwoBlocks(out a, out b, null, 3);
                grid.Step();
                if (i % 2 == 0) grid.Dispose();
                if (i % 100 == 0) { GC.Collect(); GC.WaitForPendingFinalizers(); }
            }
            long more = ResidentKilobytes() - before;
            Test.That(more < 20000, "2000 grids left " + more + " kB");
        }
    }
}
