"""A check is a name and a function that returns what is wrong: sentences, none if all is well."""
import concurrent.futures
import os
import shutil
import tempfile


class Check:
    def __init__(self, name, function):
        self.name = name
        self.function = function


class Lab:
    """Where checks work: the program, and folders of their own that go with the check."""

    def __init__(self, program, root):
        self.program = program
        self.root = root

    def folder(self, name):
        return tempfile.mkdtemp(prefix=name.replace("/", "-") + "-", dir=self.root)

    def run(self, *arguments, cwd, **options):
        return self.program.run(*arguments, cwd=cwd, **options)


def copy_with_links(source, target):
    """The folder with links in place of its pictures: what is not replaced need not be copied."""
    for base, _, names in os.walk(source):
        here = os.path.join(target, os.path.relpath(base, source))
        os.makedirs(here, exist_ok=True)
        for name in names:
            file = os.path.join(base, name)
            if name.endswith((".png", ".jpg")):
                os.symlink(os.path.realpath(file), os.path.join(here, name))
            else:
                shutil.copy(file, os.path.join(here, name))


def run_checks(checks, lab, jobs):
    """Prints a line for each that fails. Returns how many passed and failed."""
    num_failed = 0
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        for check, problems in zip(checks, pool.map(lambda check: run_one(check, lab), checks)):
            if problems:
                num_failed += 1
                print(f"FAILED {check.name}", *problems, sep="\n    ", flush=True)
    return len(checks) - num_failed, num_failed


def run_one(check, lab):
    folder = lab.folder(check.name)
    try:
        return list(check.function(lab, folder))
    except Exception as error:  # pylint: disable=broad-except
        return [f"the check itself ended with {type(error).__name__}: {error}"]
    finally:
        shutil.rmtree(folder, ignore_errors=True)
