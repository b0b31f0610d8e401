"""Files that are whole or not there, also when several processes write in one folder."""

import threading

import pytest

from mjmr.files import temporary_folder, write_atomically


def test_writers_in_one_folder_do_not_take_each_other_for_leftovers(tmp_path):
    errors = []

    def write(name):
        try:
            for k in range(300):
                write_atomically(tmp_path / name, f"{name} {k}")
                with temporary_folder(tmp_path, name) as folder:
                    (folder / "x").write_text("x")
        except OSError as e:
            errors.append(e)

    threads = [threading.Thread(target=write, args=(name,)) for name in "abcd"]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert errors == []
    assert {p.name: p.read_text() for p in tmp_path.iterdir()} == {n: f"{n} 299" for n in "abcd"}


def test_a_folder_that_is_not_there_is_an_error_at_once(tmp_path):
    with pytest.raises(FileNotFoundError):
        write_atomically(tmp_path / "no" / "a", "x")
    with pytest.raises(FileNotFoundError), temporary_folder(tmp_path / "no", "a"):
        pass
