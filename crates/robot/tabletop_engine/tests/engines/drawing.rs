//! Scripts that draw, where there is nothing to draw on.

use tabletop_engine::Trigger;
use tabletop_harness::test_with;

use crate::common::{self, Folder, Session, octave};

#[test_with(Octave)]
fn drawing_functions_do_nothing_without_a_display() {
    let calls = [
        "h = waitbar(0, 'wait'); waitbar(0.5, h); close(h); close all",
        "figure(3); set(gcf, 'name', 'mine'); p = get(gcf, 'position');",
        "surfc(peaks); meshc(peaks); pcolor(peaks); contourf(peaks); [c, h] = contour3(peaks); surface(peaks);",
        "pie([1 2]); polar(1:3, 1:3); quiver3(1, 1, 1, 1, 1, 1); comet(1:3, 1:3); plotyy(1:2, 1:2, 1:2, 1:2);",
        "fplot(@sin, [0 1]); light('position', [1 1 1]); camlight; hggroup; uicontrol('style', 'pushbutton');",
        "f = getframe(gcf); assert(size(f.cdata), [420 560 3]); linkaxes([1 2]); trisurf([1 2 3], [0 1 0], [0 0 1], [0 0 0]);",
        "sphere; cylinder; hist(rand(1, 9)); histogram(1:2); bar3(1); annotation('line'); daspect([1 1 1]); rose(1:3);",
        "ax = subplot(2, 1, 1); plot(ax, 1:3); hold on; axis equal; colormap(gray); colorbar; shading interp; zlim([0 1]);",
        "h = plot(1:3); set(h, 'xdata', 1:3); drawnow; title('x'); legend('a'); if ishandle(h), delete(h); end",
        "if ~ishold, hold on; end, delete(findobj('type', 'line')); isempty(findall(0));",
        "h = plot(1:3); set(h(1), 'YData', 1:3); pos = get(gcf, 'Position'); pos(3); yl = ylim; yl(2); l = axis; l(4);",
        "F = getframe; imwrite(F.cdata, [aux.path 'f.png']); delete([aux.path 'f.png']); M(3) = getframe; movie(M);",
        "[x, y] = stairs([1 2 3]); assert(y', [1 1 2 2 3]); [x, y] = bar([1 2]); assert(size(colormap), [64 3]);",
        "c = contour(peaks); assert(rows(c), 2); f = figure(2); if ~ishandle(f), error('gone'); end, close(f);",
        "s = get(gca); p = get(gcf, 'Position'); assert(numel(p), 4); f = ancestor(gca, 'figure'); findobj(gcf, 'Type', 'line');",
        "[n, x] = hist([1 2 3]); assert(numel(n) == 10); [x, y, z] = sphere(4); assert(rows(x) == 5);",
    ];
    for call in calls {
        let folder = Folder::pair(call, "");
        let mut config = octave(&folder.0, Trigger::Stdin);
        config.display = false;
        let session = Session::start(config).unwrap();
        let result = session.init();
        assert!(result.is_ok(), "{call}: {}", result.unwrap_err());
    }
}

#[test_with(Octave)]
fn nobody_chooses_files() {
    let folder = Folder::pair(
        "",
        "try, uigetfile('*.mat'), catch err, disp(err.message), end",
    );
    let session = Session::octave(&folder.0, Trigger::Stdin);
    session.init().unwrap();
    session.step(&common::at_rest()).unwrap();
    let printed = session.printed("nobody can choose");
    assert!(printed.contains("nobody can choose"), "{printed}");
}

#[test_with(Octave)]
fn that_no_file_is_made_is_reported_once() {
    let folder = Folder::pair("", "print('-dpng', 'x.png'); fputs(stderr, \"done\\n\");");
    let mut config = octave(&folder.0, Trigger::Stdin);
    config.display = false;
    let session = Session::start(config).unwrap();
    session.init().unwrap();
    for reported in [1, 0] {
        session.step(&common::at_rest()).unwrap();
        let printed = session.printed("done");
        assert_eq!(
            printed.matches("makes no file").count(),
            reported,
            "{printed}"
        );
    }
}
