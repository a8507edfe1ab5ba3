"""Simulate a city, corrupt it, prune it, and compare the map with the truth."""

from isotherm import slam


def main() -> None:
    clean, truth = slam.simulate_city(poses=1000, loops=400, seed=7)
    graph, labels = slam.corrupt(clean, truth, count=200, seed=7)

    result = slam.prune(graph)
    solved = slam.optimize(result.pruned())

    metrics = slam.evaluate_loops(result.verdicts, labels)
    print(f"{result.method}: precision {metrics.precision:.3f}, recall {metrics.recall:.3f}")
    most_suspicious = result.verdicts.score.argmax()
    print("most suspicious:", *result.verdicts.ends[most_suspicious])
    error = slam.absolute_trajectory_error(solved.poses, truth)
    print(f"the map is {error.rmse:.2f} m from the truth")


if __name__ == "__main__":
    main()
