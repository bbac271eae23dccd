"""More mistakes in recordings, as in broken_inputs.py: in how they are written, in their times and in what was measured."""
from broken_inputs import choose_output


def repeat_a_row_of_words(generator, rows):
    """A second recording was appended, with its line of names."""
    row = generator.randrange(5, len(rows) - 5)
    rows.insert(row, list(rows[0]))
    return rf":{row + 1}:.*'{rows[0][0]}'.*number"


def end_in_a_remark(_generator, rows):
    rows.append(["end of measurement"])
    return rf":{len(rows)}:.*(cell|number)"


def write_thousands(generator, rows):
    row = generator.randrange(2, len(rows))
    rows[row][1:2] = ["1", "234.5"]
    return rf":{row + 1}:.*cells"


def write_a_unit(generator, rows):
    i, row = choose_output(generator, rows), generator.randrange(2, len(rows))
    rows[row][i] = f"{rows[row][i]} m"
    return rf":{row + 1}:.* m'.*number"


def write_a_date(_generator, rows):
    for k, row in enumerate(rows[1:]):
        row[0] = f"26.11.2026 10:00:{0.05 * k:06.3f}"
    return r":2:.*'26\.11\.2026 10:00:00\.000'"


def write_hexadecimal(generator, rows):
    i, row = choose_output(generator, rows), generator.randrange(2, len(rows))
    rows[row][i] = "0x1F"
    return rf":{row + 1}:.*'0x1F'.*number"


def lose_times(_generator, rows):
    for row in rows:
        del row[0]
    return "no column.*(t|time)|time|sample_rate"


def stand_still(_generator, rows):
    for row in rows[1:]:
        row[0] = 0.0
    return "single time, 0 s, in all rows"


def measure_nothing(generator, rows):
    i = choose_output(generator, rows)
    for row in rows[1:]:
        row[i] = "nan"
    return rf"'{rows[0][i]}' has no number in any row"


def swap_with_time(_generator, rows):
    rows[0][0], rows[0][1] = rows[0][1], rows[0][0]
    return f"time '{rows[0][1]}' goes back .*'{rows[0][0]}' rises in every one: are the two names swapped"


def scale_time(_generator, rows):
    for row in rows[1:]:
        row[0] *= 1.02
    return r"the clock runs (1\.9\d*|2|2\.0\d*) % fast"


def shift_time(_generator, rows):
    for row in rows[1:]:
        row[0] += 0.02
    return "late|trigger|delay|shift|begins at|left out"


def turn_all_signs(_generator, rows):
    for row in rows[1:]:
        for i in range(1, len(row)):
            row[i] = -row[i]
    return "other sign|sign"


def copy_over(_generator, rows):
    for row in rows[1:]:
        row[2] = row[1]
    return "theta|same"


def hold_for_a_while(generator, rows):
    i, first = choose_output(generator, rows), generator.randrange(20, 40)
    for row in rows[first : first + 40]:
        row[i] = rows[first][i]
    return rf"{rows[0][i]} (holds .* from|is clipped in)"


def double_noise(generator, rows):
    i = choose_output(generator, rows)
    largest = max(abs(row[i]) for row in rows[1:])
    for row in rows[1:]:
        row[i] += generator.gauss(0.0, 0.1 * largest)
    return "the noise( of \\w+)? is|noise"


def drift(generator, rows):
    i = choose_output(generator, rows)
    largest = max(abs(row[i]) for row in rows[1:])
    for row in rows[1:]:
        row[i] += largest * row[0]
    return rf"{rows[0][i]} drifts by"


def write_centimetres(generator, rows):
    i = choose_output(generator, rows)
    for row in rows[1:]:
        row[i] *= 100.0
    return rf"{rows[0][i]} is 100 times too large"


def quantise(generator, rows):
    i = choose_output(generator, rows)
    largest = max(abs(row[i]) for row in rows[1:])
    for row in rows[1:]:
        row[i] = round(row[i] / largest * 4) / 4 * largest
    return "noise|largest misfit|step|residuals"


def lose_half(generator, rows):
    del rows[30:70]
    return "left out: 4|left out: 3|gap"


def name_a_column_twice(_generator, rows):
    rows[0].append(rows[0][0])
    for row in rows[1:]:
        row.append(row[0])
    return rf"'{rows[0][0]}'.*(twice|2 columns|repeated)"


TABLE_FAULTS = [
    repeat_a_row_of_words,
    end_in_a_remark,
    write_thousands,
    write_a_unit,
    write_a_date,
    write_hexadecimal,
    lose_times,
    stand_still,
    measure_nothing,
    swap_with_time,
    scale_time,
    shift_time,
    turn_all_signs,
    hold_for_a_while,
    double_noise,
    drift,
    write_centimetres,
    quantise,
    lose_half,
    name_a_column_twice,
]
TWO_COLUMN_FAULTS = [copy_over]

# (name, edit of the file's text, what must be said)
TABLE_FILE_FAULTS = [
    ("decimal commas between commas", lambda text: text.replace(".", ",").encode(), r"cells|decimal"),
    ("a spreadsheet", lambda text: b"PK\x03\x04" + bytes(range(256)) * 8, "NUL|not text|UTF-8|no column"),
    ("a web page", lambda text: b"<!DOCTYPE html>\n<html><body>404 not found</body></html>\n", "no column|header"),
    ("blanks for commas", lambda text: text.replace(",", ", ;").encode(), "no column|cells|number"),
]
