using System;

namespace Voxtet.Tests
{
    static class Test
    {
        public static void That(bool holds, string what)
        {
            if (!holds) throw new Exception(what);
        }

        public static void Same<T>(T found, T expected, string what)
        {
            if (!Equals(found, expected)) throw new Exception(what + ": " + found + ", expected " + expected);
        }

        /// <summary>The text of the exception has these words in it.</summary>
        public static void Throws<E>(Action call, string words) where E : Exception
        {
            try
            {
                call();
            }
            catch (E error)
            {
                That(error.Message.Contains(words), "the text is '" + error.Message + "', expected '" + words + "' in it");
                return;
            }
            throw new Exception("no " + typeof(E).Name + ": expected '" + words + "'");
        }

        static int Main(string[] arguments)
        {
            var tests = new System.Collections.Generic.List<Action>
            {
                Layouts, () => Vectors.Run(arguments[0]), Misuse.Errors, Misuse.Settings, Misuse.Views, Misuse.Constraints, Misuse.PreviousPositions,
                Misuse.Threads, Misuse.Locators, Misuse.Log, Misuse.CellSizes, Misuse.GridsOfOthers, Misuse.Files, Misuse.ManyGrids,
                Misuse.EmptyArrays, Shapes.EachKind, Shapes.Motion, Shapes.Field, Shapes.Refused, Misuse.AnythingGoes, Misuse.NoAllocation,
                Misuse.LogHoldsGrid, Misuse.NothingLeaks
            };
            int failed = 0;
            foreach (Action test in tests)
                try
                {
                    test();
                }
                catch (Exception error)
                {
                    Console.Error.WriteLine(test.Method.Name + ": " + error);
                    ++failed;
                }
            Console.WriteLine(tests.Count - failed + " of " + tests.Count + " tests passed, " + Native.VOX_ABI_VERSION + " is the ABI");
            return failed == 0 ? 0 : 1;
        }

        static void Layouts()
        {
            int count = 0;
            foreach (LayoutEntry entry in Layout.Entries())
            {
                Same(entry.Here, entry.Expected, entry.Name);
                ++count;
            }
            That(count > 500, "only " + count + " layouts");
        }
    }
}
