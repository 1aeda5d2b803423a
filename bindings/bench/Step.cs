// See step.c.
using System;
using System.Diagnostics;
using System.IO;
using System.Runtime.InteropServices;
using Voxtet;

static class Step
{
    static ulong Nanoseconds(long ticks) { return (ulong)(ticks * (1e9 / Stopwatch.Frequency)); }

    static void Main(string[] arguments)
    {
        byte[] file = File.ReadAllBytes(arguments[0]);
        int bodies = BitConverter.ToInt32(file, 0), frames = BitConverter.ToInt32(file, 4);
        var vertices = new int[bodies];
        var tetCounts = new int[bodies];
        int at = 8;
        for (int b = 0; b < bodies; ++b, at += 8)
        {
            vertices[b] = BitConverter.ToInt32(file, at);
            tetCounts[b] = BitConverter.ToInt32(file, at + 4);
        }
        int tets = at, positions = at;
        for (int b = 0; b < bodies; ++b) positions += 16 * tetCounts[b];
        using (var grid = new Grid())
        {
            var meshes = new Body[bodies];
            at = positions;
            for (int b = 0; b < bodies; ++b)
            {
                meshes[b] = grid.Add(Part<float>(file, at, 3 * vertices[b]), Part<uint>(file, tets, 4 * tetCounts[b]));
                at += 12 * vertices[b];
                tets += 16 * tetCounts[b];
            }
            for (string line; (line = Console.ReadLine()) != null;)
            {
                ulong hashes = 0;
                var least = new ulong[2 * frames];
                for (int i = 0; i < least.Length; ++i) least[i] = ulong.MaxValue;
                for (int pass = int.Parse(line); pass > 0; --pass)
                {
                    at = positions;
                    for (int f = 0; f < frames; ++f)
                    {
                        for (int b = 0; b < bodies; ++b)
                        {
                            grid.GetPositions(meshes[b]).Set(Part<float>(file, at, 3 * vertices[b]));
                            at += 12 * vertices[b];
                        }
                        long begin = Stopwatch.GetTimestamp();
                        grid.Step();
                        long stepped = Stopwatch.GetTimestamp();
                        foreach (Contact c in grid.Contacts) hashes += c.vertex;
                        long end = Stopwatch.GetTimestamp();
                        least[2 * f] = Math.Min(least[2 * f], Nanoseconds(stepped - begin));
                        least[2 * f + 1] = Math.Min(least[2 * f + 1], Nanoseconds(end - stepped));
                        hashes += grid.Hash;
                    }
                }
                Console.WriteLine(hashes.ToString("x16") + " " + string.Join(" ", least));
            }
        }
    }

    static ReadOnlySpan<T> Part<T>(byte[] file, int at, int count) where T : struct
    {
        return MemoryMarshal.Cast<byte, T>(new ReadOnlySpan<byte>(file, at, 4 * count));
    }
}
