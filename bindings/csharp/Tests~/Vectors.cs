using System;
using System.Collections.Generic;
using System.IO;
using System.Linq;
using System.Runtime.InteropServices;

namespace Voxtet.Tests
{
    /// <summary>Replays bindings/vectors: the same results as in every other language.</summary>
    sealed class Vectors
    {
        readonly byte[] arrays;
        readonly object script;
        Grid grid;
        Locator locator;
        string place;

        Vectors(string folder)
        {
            arrays = File.ReadAllBytes(Path.Combine(folder, "vectors.bin"));
            script = Json.Parse(File.ReadAllText(Path.Combine(folder, "vectors.json")));
        }

        public static void Run(string folder)
        {
            var vectors = new Vectors(folder);
            int calls = 0;
            foreach (Dictionary<string, object> scene in (List<object>)((Dictionary<string, object>)vectors.script)["scenes"])
                foreach (Dictionary<string, object> call in (List<object>)scene["calls"])
                {
                    vectors.place = scene["name"] + ": " + call["call"] + " " + calls;
                    vectors.Replay(new Call(call));
                    ++calls;
                }
            vectors.locator.Dispose();
            vectors.grid.Dispose();
            Test.That(calls > 300, "only " + calls + " calls");
        }

        struct Call
        {
            public readonly Dictionary<string, object> Fields;
            public Call(Dictionary<string, object> fields) { Fields = fields; }
            public bool Has(string name) { return Fields.ContainsKey(name); }
            public double Number(string name) { return (double)Fields[name]; }
            public uint Uint(string name) { return (uint)(double)Fields[name]; }
            public string Text(string name) { return (string)Fields[name]; }
            public Body Body(string name = "mesh") { return new Body(Has(name) ? Uint(name) : 0); }
        }

        void Replay(Call call)
        {
            if (!call.Has("fails"))
            {
                Make(call);
                return;
            }
            // Arguments that a bool rules out.
            if (call.Has("enabled") && call.Number("enabled") > 1) return;
            try
            {
                Make(call);
            }
            catch (VoxException error)
            {
                Test.Same((double)(int)error.Code, call.Number("fails"), place);
                Test.Same(error.Message, call.Text("text"), place);
                return;
            }
            Test.That(false, place + " did not fail");
        }

        T[] Array<T>(Call call, string name, ulong count) where T : struct
        {
            return MemoryMarshal.Cast<byte, T>(new ReadOnlySpan<byte>(arrays, (int)call.Number(name),
                                                                      (int)count * Marshal.SizeOf(typeof(T)))).ToArray();
        }

        static ulong HashOf(ReadOnlySpan<byte> bytes)
        {
            ulong hash = 0xcbf29ce484222325;
            foreach (uint w in MemoryMarshal.Cast<byte, uint>(bytes))
                hash = unchecked((hash ^ (w == 0x80000000 ? 0 : w)) * 0x100000001b3);
            return hash;
        }

        void Check<T>(Call call, string name, ReadOnlySpan<T> items) where T : struct
        {
            var expected = (List<object>)call.Fields[name];
            Test.Same((double)items.Length, (double)expected[0], place + ": " + name);
            Test.Same(HashOf(MemoryMarshal.AsBytes(items)).ToString("x16"), (string)expected[1], place + ": " + name);
        }

        void Check(Call call, string name, double found) { Test.Same(found, call.Number(name), place + ": " + name); }

        static Filter FilterOf(Call call)
        {
            var fields = new Call((Dictionary<string, object>)call.Fields["filter"]);
            return new Filter
            {
                flags = (FilterFlags)fields.Uint("flags"), group = (int)fields.Number("group"),
                category = ulong.Parse(fields.Text("category")), mask = ulong.Parse(fields.Text("mask")),
                world = fields.Uint("world"), self_rings = fields.Uint("self_rings"),
                self_rest_distance = fields.Number("self_rest_distance")
            };
        }

        double[] Points(Call call, string name) { return Array<double>(call, name, 3 * call.Uint("count")); }

        void Make(Call call)
        {
            Body mesh = call.Body();
            uint count = call.Has("count") ? call.Uint("count") : 0;
            switch (call.Text("call"))
            {
                case "create":
                    if (grid != null) grid.Dispose();
                    grid = new Grid(new GridOptions { Flags = (GridFlags)call.Uint("flags"), CellSize = call.Number("cell_size") });
                    break;
                case "insert":
                {
                    uint[] tets = Array<uint>(call, "tets", 4 * call.Uint("tet_count"));
                    ulong userData = ulong.Parse(call.Text("user_data"));
                    Filter filter = call.Has("filter") ? FilterOf(call) : default(Filter);
                    Body added = call.Uint("format") == 1
                                     ? grid.Add(Array<double>(call, "positions", 3 * call.Uint("vertices")), tets, userData, filter)
                                     : grid.Add(Array<float>(call, "positions", 3 * call.Uint("vertices")), tets, userData, filter);
                    Test.Same((double)added.Id, call.Number("mesh"), place);
                    break;
                }
                case "move":
                    if (call.Uint("format") == 1)
                        grid.GetDoublePositions(mesh).Set(Array<double>(call, "positions", 3 * call.Uint("vertices")));
                    else
                        grid.GetPositions(mesh).Set(Array<float>(call, "positions", 3 * call.Uint("vertices")));
                    break;
                case "step":
                    grid.Step();
                    break;
                case "results":
                    Results(call);
                    break;
                case "find_constraints":
                    grid.FindConstraints((DepthMethod)call.Uint("method"));
                    Constraints(call);
                    break;
                case "update_locator":
                    if (locator == null) locator = grid.TakeLocator();
                    else locator.Update(grid);
                    break;
                case "find_point_hits":
                {
                    var hits = new PointHit[4096];
                    int found = (int)locator.FindPointHits(Points(call, "points"), hits);
                    Check(call, "hits", new ReadOnlySpan<PointHit>(hits, 0, found));
                    break;
                }
                case "find_closest":
                {
                    var hits = new ClosestHit[count];
                    locator.FindClosest(Points(call, "points"), hits);
                    Check<ClosestHit>(call, "hits", hits);
                    break;
                }
                case "find_box_hits":
                {
                    var hits = new BoxHit[1 << 17];
                    int found = (int)locator.FindBoxHits(Points(call, "min"), Points(call, "max"), hits);
                    Check(call, "hits", new ReadOnlySpan<BoxHit>(hits, 0, found));
                    break;
                }
                case "find_ray_hits":
                {
                    var hits = new RayHit[4096];
                    var desc = new QueryDesc { flags = (QueryFlags)call.Uint("flags") };
                    int found = (int)locator.FindRayHits(Points(call, "from"), Points(call, "to"), hits, desc);
                    Check(call, "hits", new ReadOnlySpan<RayHit>(hits, 0, found));
                    break;
                }
                case "test_rays":
                {
                    var blocked = new byte[count];
                    locator.TestRays(Points(call, "from"), Points(call, "to"), blocked);
                    Check(call, "blocked", blocked.Sum(b => b));
                    break;
                }
                case "meshes":
                    Meshes(call);
                    break;
                case "set_transform":
                    grid.SetTransform(mesh, Array<double>(call, "matrix", 12));
                    break;
                case "set_filter":
                    grid.SetFilter(mesh, FilterOf(call));
                    break;
                case "set_enabled":
                    grid.SetEnabled(mesh, call.Uint("enabled") != 0);
                    break;
                case "set_pair_enabled":
                    grid.SetPairEnabled(call.Body("body_a"), call.Body("body_b"), call.Uint("enabled") != 0);
                    break;
                case "set_flags":
                    grid.Flags = (GridFlags)call.Uint("flags");
                    break;
                case "remove":
                    grid.Remove(mesh);
                    break;
                case "clear":
                    grid.Clear();
                    break;
                case "set_tets_enabled":
                    grid.SetTetsEnabled(mesh, Array<uint>(call, "indices", count), call.Uint("enabled") != 0);
                    break;
                case "remove_tets":
                    grid.RemoveTets(mesh, Array<uint>(call, "indices", count));
                    break;
                case "append_copies":
                    Check(call, "first", grid.AppendCopies(mesh, Array<uint>(call, "copies_of", count)));
                    break;
                case "replace_tets":
                    grid.ReplaceTets(mesh, Array<uint>(call, "indices", count), Array<uint>(call, "corners", 4 * count));
                    break;
                case "append_tets":
                    Check(call, "first", grid.AppendTets(mesh, Array<uint>(call, "corners", 4 * count)));
                    break;
                case "save":
                {
                    byte[] bytes = grid.Save();
                    Check(call, "size", bytes.Length);
                    System.Array.Resize(ref bytes, (bytes.Length + 3) / 4 * 4);
                    Test.Same(HashOf(bytes).ToString("x16"), call.Text("hash"), place);
                    break;
                }
                case "load":
                {
                    Grid loaded = Grid.Load(new ReadOnlySpan<byte>(arrays, (int)call.Number("bytes"), (int)call.Number("size")));
                    grid.Dispose();
                    grid = loaded;
                    break;
                }
                case "suggest":
                    Suggest(call);
                    break;
                case "foreign_suggest":
                    CheckSuggestion(call, CellSize.Suggest(GridOf(call)));
                    break;
                case "foreign_count":
                {
                    ForeignCounts c = CellSize.Count(GridOf(call), call.Number("at"));
                    Near(call, "counts", c.stored, c.visits, c.empty, c.reads, c.occupied, c.cells);
                    break;
                }
                case "foreign_fit":
                    Fit(call);
                    break;
                case "foreign_tune":
                    Tune(call);
                    break;
                default:
                    throw new ArgumentException("a call that is not known: " + call.Text("call"));
            }
        }

        void Results(Call call)
        {
            Test.Same(grid.Hash.ToString("x16"), call.Text("hash"), place);
            Check(call, "epoch", grid.Epoch);
            Check(call, "contacts", grid.Contacts.AsSpan());
            int interior = 0;
            foreach (byte i in grid.Interiors) interior += i;
            Check(call, "interior", interior);
            Check(call, "pairs", grid.Pairs.AsSpan());
            Check(call, "pair_contacts", grid.PairContacts.AsSpan());
            if (call.Has("constraints")) Constraints(call);
            else Test.Throws<VoxException>(() => { var c = grid.Constraints; }, "VOX_GRID_CONSTRAINTS");
        }

        void Constraints(Call call)
        {
            Check(call, "constraints", grid.Constraints.AsSpan());
            Check(call, "pair_offsets", grid.PairOffsets.AsSpan());
        }

        void Meshes(Call call)
        {
            var expected = (List<object>)call.Fields["meshes"];
            Body[] found = grid.GetBodies();
            Test.Same((double)found.Length, (double)expected.Count, place);
            for (int i = 0; i < found.Length; ++i)
            {
                var mesh = new Call((Dictionary<string, object>)expected[i]);
                BodyFacts facts = grid.GetFacts(found[i]);
                Test.Same(facts.UserData.ToString(), mesh.Text("user_data"), place);
                Check(mesh, "mesh", found[i].Id);
                Check(mesh, "vertices", facts.VertexCount);
                Check(mesh, "tet_count", facts.TetCount);
                Check(mesh, "enabled_tets", facts.EnabledTetCount);
                Check(mesh, "enabled", facts.Enabled ? 1 : 0);
                Check(mesh, "flags", (uint)facts.Flags);
                Check(mesh, "format", (int)facts.Format);
                uint[] tets = grid.GetTets(found[i]);
                Test.Same(HashOf(MemoryMarshal.AsBytes(new ReadOnlySpan<uint>(tets))).ToString("x16"), mesh.Text("tets"), place);
            }
        }

        void Suggest(Call call)
        {
            var meshes = (List<object>)call.Fields["meshes"];
            var positions = new float[meshes.Count][];
            var tets = new uint[meshes.Count][];
            for (int i = 0; i < meshes.Count; ++i)
            {
                var mesh = new Call((Dictionary<string, object>)meshes[i]);
                positions[i] = Array<float>(mesh, "positions", 3 * mesh.Uint("vertices"));
                tets[i] = Array<uint>(mesh, "tets", 4 * mesh.Uint("tet_count"));
            }
            CheckSuggestion(call, CellSize.Suggest(positions, tets, (CostModel)call.Uint("model")));
        }

        void CheckSuggestion(Call call, Suggestion found)
        {
            Near(call, "cell_size", found.CellSize);
            Near(call, "zone_min", found.ZoneMin);
            Near(call, "zone_max", found.ZoneMax);
            Near(call, "cost", found.Cost);
            Near(call, "result_min_cell_size", found.MinCellSize);
            Near(call, "rules", System.Array.ConvertAll(found.Rules, rule => rule.CellSize));
            Near(call, "runs", System.Array.ConvertAll(found.Timings, timing => timing.cell_size));
            Check(call, "curve_count", found.Curve.Length);
            Check(call, "term_count", found.Terms.Length);
            Check(call, "warnings", (uint)found.Warnings);
            Test.Same(found.Note, call.Text("note"), place);
        }

        /// <summary>Within one part in a million: a number, or a list of them.</summary>
        void Near(Call call, string name, params double[] found)
        {
            object field = call.Fields[name];
            List<object> expected = field as List<object> ?? new List<object> { field };
            Test.Same((double)found.Length, (double)expected.Count, place + ": " + name);
            for (int i = 0; i < found.Length; ++i)
                Test.That(Math.Abs(found[i] - (double)expected[i]) <= 1e-6 * Math.Abs((double)expected[i]),
                          place + ": " + name + " is " + found[i] + ", expected " + expected[i]);
        }

        PrimitiveArrays PrimitivesOf(Call call, string name)
        {
            var given = new Call((Dictionary<string, object>)call.Fields[name]);
            var type = (PrimitiveType)given.Uint("type");
            uint vertices = given.Uint("vertices");
            uint[] indices = given.Has("indices") ? Array<uint>(given, "indices", given.Uint("count")) : null;
            PrimitiveArrays primitives = given.Uint("format") == 1
                                             ? new PrimitiveArrays(type, Array<double>(given, "positions", 3 * vertices), indices)
                                             : new PrimitiveArrays(type, Array<float>(given, "positions", 3 * vertices), indices);
            primitives.Radius = given.Number("radius");
            if (given.Has("radii")) primitives.Radii = Array<double>(given, "radii", vertices);
            return primitives;
        }

        GridDescription GridOf(Call call)
        {
            List<double> w = ((List<object>)call.Fields["weights"]).ConvertAll(x => (double)x);
            return new GridDescription(PrimitivesOf(call, "stored"), (KnownGrid)call.Uint("known"))
            {
                Querying = call.Has("querying") ? PrimitivesOf(call, "querying") : null,
                CellsStored = (CellsStored)call.Uint("cells_stored"), CellsQueried = (CellsQueried)call.Uint("cells_queried"),
                CellsKept = (CellsKept)call.Uint("cells_kept"), Radius = call.Number("radius"),
                MinCellSize = call.Number("min_cell_size"), ZoneLoss = call.Number("zone_loss"),
                Weights = new ForeignWeights
                {
                    run = w[0], store = w[1], visit = w[2], found = w[3], read = w[4], occupied = w[5], cell = w[6]
                }
            };
        }

        void Fit(Call call)
        {
            var timings = new List<Timing>();
            foreach (List<object> pair in (List<object>)call.Fields["timings"])
                timings.Add(new Timing { cell_size = (double)pair[0], seconds = (double)pair[1] });
            CheckSuggestion(call, CellSize.Fit(GridOf(call), timings.ToArray()));
        }

        void Tune(Call call)
        {
            var desc = new TuneDesc { first = call.Number("first"), max_runs = call.Uint("max_runs") };
            List<double> seconds = ((List<object>)call.Fields["run"]).ConvertAll(x => (double)x);
            double most = call.Number("stops_after"), below = call.Number("fails_below");
            int runs = 0;
            Func<double, double> run = d =>
            {
                if (++runs > most && most != 0) return -1;
                return d < below ? double.PositiveInfinity : seconds[0] + seconds[1] / (d * d) + seconds[2] * (d * d);
            };
            CheckSuggestion(call, CellSize.Tune(run, call.Has("stored") ? GridOf(call) : null, desc));
        }
    }
}
